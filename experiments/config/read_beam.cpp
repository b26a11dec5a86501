#include "experiments/config/read_beam.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/config/read_attachments.hpp"
#include "experiments/config/read_segment.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/text/method_choice.hpp"
#include "experiments/text/spelling.hpp"
#include "fem/buckling.hpp"

namespace beamid::experiments {
namespace {

const std::vector<std::string> end_kinds{"clamped", "pinned", "guided", "free"};

void read_segments(const TomlTable& table, fem::Beam& beam) {
  const std::vector<TomlTable> segments = table.find_tables("segments");
  if (segments.empty()) {
    beam.segments = {read_segment(table)};
    return;
  }
  refuse_useless(table, segment_keys(), "beside beam.segments", "it in each of beam.segments");
  for (const TomlTable& segment : segments) beam.segments.push_back(read_segment(segment));
}

// An elastic root: a spring where the support would hold.
void read_root(const TomlTable& table, fem::Beam& beam) {
  const auto rotational = table.find_number("root_rotational_stiffness_n_m_per_rad", Sign::not_negative);
  const auto translational = table.find_number("root_translational_stiffness_n_per_m", Sign::not_negative);
  for (fem::Support& support : beam.supports) {
    if (support.position != 0.0) continue;
    support.rotation &= !rotational;
    support.deflection &= !translational;
  }
  std::erase_if(beam.supports, [](const fem::Support& one) { return !one.deflection && !one.rotation; });
  if (rotational || translational)
    beam.springs.push_back({0.0, translational.value_or(0.0), rotational.value_or(0.0), 0.0});
}

void read_tip(const TomlTable& table, fem::Beam& beam) {
  const double mass = table.find_number("tip_mass_kg", Sign::not_negative).value_or(0);
  const double sensor = table.find_number("sensor_mass_kg", Sign::not_negative).value_or(0);
  const double inertia = table.find_number("tip_rotary_inertia_kg_m2", Sign::not_negative).value_or(0);
  const double eccentricity = table.find_number("tip_eccentricity_m").value_or(0);
  // The tip's body comes first, also without mass, so that the sensor is not taken for it.
  if (mass > 0.0 || inertia > 0.0 || sensor > 0.0)
    beam.bodies.push_back({beam.length(), mass, inertia, eccentricity});
  if (sensor > 0.0) beam.bodies.push_back({beam.length(), sensor, 0.0, 0.0});
}

// Closer to the buckling load than this, relative, a frequency has no digits.
constexpr double nearest_to_buckling = 1e-7;

void refuse_buckled(const TomlTable& table, const fem::Beam& beam) {
  if (!(beam.axial_load > 0.0)) return;
  const auto most = fem::buckling_load(beam);
  if (most && beam.axial_load > (1.0 - nearest_to_buckling) * *most)
    throw InputError(
        table.value_place("axial_load_n"),
        fmt::format("axial_load_n is {:.10g}; the beam buckles at {:.6g} N of compression, expected "
                    "less than that",
                    beam.axial_load, *most));
}

}  // namespace

const std::vector<std::string>& end_supports() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const std::string& root : end_kinds)
      for (const std::string& tip : end_kinds) all.push_back(root + "-" + tip);
    return all;
  }();
  return names;
}

std::vector<fem::Support> supports_of(const std::string& name, double length) {
  std::vector<fem::Support> supports;
  const auto hold = [&](const std::string& kind, double position) {
    const bool deflection = kind == "clamped" || kind == "pinned",
               rotation = kind == "clamped" || kind == "guided";
    if (deflection || rotation) supports.push_back({position, deflection, rotation});
  };
  const std::size_t dash = name.find('-');
  hold(name.substr(0, dash), 0.0);
  hold(name.substr(dash + 1), length);
  return supports;
}

fem::Beam read_beam(const TomlTable& table) {
  fem::Beam beam;
  read_segments(table, beam);
  const std::string support = table.find_text("support").value_or("clamped-free");
  if (std::find(end_supports().begin(), end_supports().end(), support) == end_supports().end())
    throw InputError(table.value_place("support"),
                     "unknown '" + support + "'; known: " + joined(end_supports()));
  beam.supports = supports_of(support, beam.length());
  read_root(table, beam);
  read_tip(table, beam);
  beam.axial_load = table.find_number("axial_load_n").value_or(0.0);
  const auto mass_model = table.find_text("mass_model", {"consistent", "lumped"});
  beam.mass_model = mass_model == "lumped" ? fem::MassModel::lumped : fem::MassModel::consistent;
  read_attachments(table, beam);
  at_place(table.place(), [&] { fem::validate(beam); });
  refuse_buckled(table, beam);
  return beam;
}

}  // namespace beamid::experiments
