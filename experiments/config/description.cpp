#include "experiments/config/description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "experiments/config/effective_keys.hpp"
#include "experiments/config/structure_description.hpp"
#include "fem/shear_building.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

std::string range(const fem::Beam& beam,
                  const std::function<const fem::Variation&(const fem::Section&)>& quantity) {
  double least = INFINITY, most = -INFINITY;
  for (const fem::Segment& segment : beam.segments)
    for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      least = std::min(least, quantity(segment.section)(s));
      most = std::max(most, quantity(segment.section)(s));
    }
  return least == most ? fmt::format("{:.6g}", least) : fmt::format("{:.6g} to {:.6g}", least, most);
}

std::string held(const fem::Beam& beam) {
  std::string text;
  for (const fem::Support& support : beam.supports)
    text += fmt::format("{}{} at {:g} m", text.empty() ? "" : ", ",
                        !support.rotation    ? "pinned"
                        : support.deflection ? "clamped"
                                             : "guided",
                        support.position);
  return text.empty() ? "nowhere held" : text;
}

std::string count(std::size_t number, const char* one, const char* many) {
  return number == 0 ? "" : fmt::format("; {} {}", number, number == 1 ? one : many);
}

std::string storeys_text(const fem::Beam& beam) {
  double softest = INFINITY, stiffest = 0.0, lightest = INFINITY, heaviest = 0.0;
  for (const fem::Segment& storey : beam.segments) {
    const double k = fem::storey_stiffness(storey);
    softest = std::min(softest, k), stiffest = std::max(stiffest, k);
  }
  for (const fem::Body& floor : beam.bodies)
    lightest = std::min(lightest, floor.mass), heaviest = std::max(heaviest, floor.mass);
  const auto span = [](double least, double most) {
    return least == most ? fmt::format("{:.6g}", least) : fmt::format("{:.6g} to {:.6g}", least, most);
  };
  return fmt::format("Chain: {} floors of {} kg on storeys of {} N/m, {:.6g} m high; {} degrees of freedom.",
                     beam.segments.size(), span(lightest, heaviest), span(softest, stiffest), beam.length(),
                     beam.segments.size());
}

}  // namespace

std::string bending_stiffness_text(const fem::Beam& beam) {
  return range(
      beam, [](const auto& s) -> auto& { return s.bending_stiffness; });
}

std::string damping_text(const fem::DampingLaw& law, const fem::StructuralSystem& system) {
  const std::string text = fem::name(law);
  if (system.damping.nonZeros() == 0) return text;
  return std::holds_alternative<fem::Undamped>(law) ? "dashpots" : text + " and dashpots";
}

std::string beam_text(const fem::Beam& beam, int elements, Eigen::Index coordinates) {
  if (beam.shear_building) return storeys_text(beam);
  const bool timoshenko =
      std::any_of(beam.segments.begin(), beam.segments.end(),
                  [](const fem::Segment& segment) { return segment.section.shear_stiffness; });
  std::string text =
      fmt::format("{} beam: {:g} m, EI = {} N m2, {} kg/m, {:.6g} kg; {}",
                  timoshenko ? "Timoshenko" : "Euler-Bernoulli", beam.length(), bending_stiffness_text(beam),
                  range(
                      beam, [](const auto& s) -> auto& { return s.mass_per_length; }),
                  beam.mass(), held(beam));
  for (const fem::Body& body : beam.bodies) {
    text += fmt::format("; {:.6g} kg", body.mass);
    if (body.rotary_inertia != 0.0) text += fmt::format(", {:.6g} kg m2", body.rotary_inertia);
    text += body.position == beam.length() ? " at the tip" : fmt::format(" at {:g} m", body.position);
    if (body.eccentricity != 0.0) text += fmt::format(", {:g} m beyond", body.eccentricity);
  }
  for (const fem::Spring& spring : beam.springs) {
    std::string constants;
    const auto add = [&](double value, const char* unit) {
      if (value != 0.0) constants += fmt::format("{}{:.6g} {}", constants.empty() ? "" : ", ", value, unit);
    };
    add(spring.translational, "N/m"), add(spring.rotational, "N m/rad"), add(spring.cubic, "N/m3");
    text +=
        fmt::format("; at {:g} m a spring of {}", spring.position, constants.empty() ? "0 N/m" : constants);
  }
  text += count(beam.dashpots.size(), "dashpot", "dashpots") +
          count(beam.absorbers.size(), "absorber", "absorbers") +
          count(beam.damages.size(), "damage", "damages") +
          count(beam.added_masses.size(), "added mass", "added masses");
  if (beam.axial_load != 0.0)
    text += fmt::format("; {:.6g} N of {}", std::abs(beam.axial_load),
                        beam.axial_load > 0.0 ? "compression" : "tension");
  return text + fmt::format(". {} elements{}, {} degrees of freedom.", elements,
                            beam.mass_model == fem::MassModel::lumped ? " with lumped mass" : "",
                            coordinates);
}

Json describe(const Experiment& experiment, const std::vector<std::string>& also) {
  Json json{{"title", experiment.title}};
  if (experiment.file) json["experiment"] = effective_keys(experiment, also);
  json["structure"] = describe(experiment.structure, experiment.elements);
  return json;
}

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

}  // namespace beamid::experiments
