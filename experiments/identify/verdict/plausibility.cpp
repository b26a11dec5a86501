#include "experiments/identify/verdict/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/config/read_experiment.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {
namespace {

using Sentences = std::vector<std::string>;

constexpr double slenderest = 0.2, least_modulus = 1e8, most_modulus = 1e12, least_density = 100,
                 most_density = 25000, lowest_hz = 0.01, highest_hz = 20000;

/// @param whole "beam", or what else has this length.
void check_segment(const fem::Section& section, double length, const std::string& of, const char* whole,
                   Sentences& found) {
  const fem::Outline& outline = section.outline;
  if (outline.shape == fem::Outline::Shape::none) return;
  constexpr double middle = 0.5;
  const bool round = outline.shape == fem::Outline::Shape::ellipse;
  const double width = outline.width(middle), height = outline.height(middle);
  const double area = (round ? 0.25 * std::numbers::pi : 1.0) * width * height;
  const double second_moment = (round ? std::numbers::pi / 64.0 : 1.0 / 12.0) * width * std::pow(height, 3);
  const double modulus = section.bending_stiffness(middle) / second_moment,
               density = section.mass_per_length(middle) / area;
  if (height > slenderest * length)
    found.push_back(fmt::format("{}{} of {:.4g} m is more than a fifth of the {}'s length of {:.4g} m.", of,
                                round ? "diameter" : "height", height, whole, length));
  if (!(modulus >= least_modulus && modulus <= most_modulus))
    found.push_back(fmt::format("{}Young's modulus is {:.4g} Pa; materials have {:g} to {:g} Pa.", of,
                                modulus, least_modulus, most_modulus));
  if (!(density >= least_density && density <= most_density))
    found.push_back(fmt::format("{}density is {:.4g} kg/m3; materials have {:g} to {:g} kg/m3.", of, density,
                                least_density, most_density));
}

void check_frequency(double first, Sentences& found) {
  if (first < lowest_hz || first > highest_hz)
    found.push_back(fmt::format("The first frequency is {:.4g} Hz; expected {:g} Hz to {:g} kHz.", first,
                                lowest_hz, 1e-3 * highest_hz));
}

void check_modes(const Experiment& experiment, Sentences& found) {
  constexpr int rigid_motions = 3;
  const int enough_elements = experiment.structure.is_beam() ? 20 : 4;  // of each member
  try {
    const fem::StructuralSystem system =
        fem::assemble(experiment.structure, std::min(experiment.elements, enough_elements));
    const fem::Modes modes = fem::modes(system, std::min<Eigen::Index>(rigid_motions + 1, system.size()));
    if (modes.rigid >= modes.size()) return;
    check_frequency(modes.frequency_hz()[modes.rigid], found);
    const double ratio =
        fem::damping_ratios(experiment.damping, modes.angular_frequency.tail(modes.size() - modes.rigid))[0];
    if (ratio >= 1.0)
      found.push_back(
          fmt::format("The damping ratio is {:.4g}, {:.4g} % of critical.", ratio, 100.0 * ratio));
  } catch (const std::exception&) {  // the command itself says so
  }
}

void check_supports(const fem::Beam& beam, Sentences& found) {
  const double same_place = 1e-9 * beam.length();  // of the mesh's nodes
  for (std::size_t i = 0; i < beam.supports.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (std::abs(beam.supports[i].position - beam.supports[j].position) < same_place)
        found.push_back(
            fmt::format("Two supports at {:.6g} m are taken for one that holds what either holds.",
                        beam.supports[i].position));
}

void check_damages(const fem::Beam& beam, Sentences& found) {
  for (std::size_t i = 0; i < beam.damages.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const fem::Damage &one = beam.damages[j], &other = beam.damages[i];
      const double from = std::max(one.from, other.from), to = std::min(one.to, other.to);
      if (from < to)
        found.push_back(fmt::format(
            "Damages {} and {} overlap from {:.4g} to {:.4g} m; together they take {:.4g} % of the stiffness "
            "there.",
            j + 1, i + 1, from, to, 100.0 * (1.0 - (1.0 - one.loss) * (1.0 - other.loss))));
    }
}

/// Diagonal of the rectangle around all joints [m].
double extent(const fem::Frame& frame) {
  const auto [left, right] = std::minmax_element(frame.joints.begin(), frame.joints.end(),
                                                 [](const auto& a, const auto& b) { return a.x < b.x; });
  const auto [low, high] = std::minmax_element(frame.joints.begin(), frame.joints.end(),
                                               [](const auto& a, const auto& b) { return a.y < b.y; });
  return std::hypot(right->x - left->x, high->y - low->y);
}

void check_members(const fem::Frame& frame, Sentences& found) {
  const double size = extent(frame);
  for (std::size_t i = 0; i < frame.members.size(); ++i)
    check_segment(frame.members[i].section, size, fmt::format("member {}: the ", i + 1), "frame", found);
}

void check_segments(const fem::Beam& beam, Sentences& found) {
  for (std::size_t i = 0; i < beam.segments.size(); ++i)
    check_segment(beam.segments[i].section, beam.length(),
                  beam.segments.size() == 1 ? "the beam's " : fmt::format("segment {}: the ", i + 1), "beam",
                  found);
}

Sentences as_wrong_units(const Sentences& units) {
  Sentences found;
  for (const std::string& sentence : units) found.push_back("Implausible, check the units: " + sentence);
  return found;
}

void put_first(Results& results, const Sentences& found) {
  if (found.empty()) return;
  auto place = results.report.begin();
  if (place != results.report.end() && std::holds_alternative<Heading>(*place)) ++place;
  for (const std::string& sentence : found)
    place = results.report.insert(place, Paragraph{sentence, Severity::none, true}) + 1;
  for (const std::string& sentence : found) results.values["beam_warnings"].push_back(sentence);
}

}  // namespace

Sentences implausible(const Experiment& experiment) {
  Sentences units;
  if (const fem::Frame* const frame = experiment.structure.frame())
    check_members(*frame, units);
  else if (!experiment.structure.is_beam())
    return units;
  else if (!experiment.structure.is_chain())  // which has no sections
    check_segments(experiment.structure.beam(), units);
  check_modes(experiment, units);
  Sentences found = as_wrong_units(units);
  if (!experiment.structure.is_beam()) return found;
  check_supports(experiment.structure.beam(), found);
  check_damages(experiment.structure.beam(), found);
  return found;
}

void warn(Results& results, const Experiment& experiment) {
  put_first(results, implausible(experiment));
}

void warn_of_file(Results& results, const std::string& file) {
  if (!file.empty()) warn(results, read_experiment(file));
}

}  // namespace beamid::experiments
