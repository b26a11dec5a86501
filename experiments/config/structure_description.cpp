#include "experiments/config/structure_description.hpp"

#include <fmt/format.h>

#include "experiments/config/beam_description.hpp"
#include "experiments/config/description.hpp"
#include "experiments/config/frame_description.hpp"
#include "experiments/config/space_frame_description.hpp"
#include "experiments/config/storey_laws.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

std::string factors_text(const fem::Structure& structure) {
  const std::vector<std::string> names = fem::factor_names(structure);
  return names.empty() ? "" : fmt::format(" Factors: {}.", joined(names));
}

Json describe_matrices(const fem::MatrixSystem& system) {
  return {{"unknowns", system.labels},
          {"mass_entries", system.mass.nonZeros()},
          {"stiffness_entries", system.stiffness.nonZeros()},
          {"damping_entries", system.damping.nonZeros()}};
}

Json describe_members(const fem::Frame& frame) {
  Json members = Json::array();
  for (std::size_t i = 0; i < frame.members.size(); ++i)
    members.push_back(describe(fem::Segment{frame.length(i), frame.members[i].section}));
  return members;
}

Json describe_segments(const fem::Beam& beam) {
  Json segments = Json::array();
  for (const fem::Segment& segment : beam.segments) segments.push_back(describe(segment));
  return segments;
}

}  // namespace

std::string structure_text(const Experiment& experiment, Eigen::Index elements, Eigen::Index coordinates) {
  const fem::Structure& structure = experiment.structure;
  if (const fem::Frame* const frame = structure.frame())
    return frame_text(*frame, experiment.elements, coordinates) + factors_text(structure);
  if (const fem::SpaceFrame* const frame = structure.space_frame())
    return space_frame_text(*frame, experiment.elements, coordinates) + factors_text(structure);
  if (const fem::MatrixSystem* const matrices = structure.matrices())
    return fmt::format("System of {} unknowns, {} to {}, from matrices of its own{}.", coordinates,
                       matrices->labels.front(), matrices->labels.back(),
                       matrices->damping.nonZeros() > 0 ? ", damping included" : "") +
           factors_text(structure);
  const std::string laws = storey_laws_text(experiment.storey_springs);
  return beam_text(structure.beam(), static_cast<int>(elements), coordinates) +
         (laws.empty() ? "" : " Laws of storeys: " + laws + ".");
}

Json describe(const fem::Structure& structure, int elements) {
  if (const fem::MatrixSystem* const matrices = structure.matrices()) return describe_matrices(*matrices);
  Json json{{"total_mass_kg", total_mass(structure)}};
  if (structure.is_chain()) return json;
  if (structure.is_beam()) {
    const fem::Beam& beam = structure.beam();
    json.update({{"elements", elements},
                 {"length_m", beam.length()},
                 {"mass_kg", beam.mass()},
                 {"segments", describe_segments(beam)}});
  } else {
    json["elements_per_member"] = elements;
    json["members"] =
        structure.frame() ? describe_members(*structure.frame()) : describe_members(*structure.space_frame());
  }
  return json;
}

double total_mass(const fem::Structure& structure) {
  if (const fem::Frame* const frame = structure.frame()) return total_mass(*frame);
  if (const fem::SpaceFrame* const frame = structure.space_frame()) return total_mass(*frame);
  if (const fem::MatrixSystem* const matrices = structure.matrices()) {
    const Eigen::VectorXd& base = matrices->base_motion;
    return base.size() > 0 ? base.dot(matrices->mass * base) : 0.0;
  }
  return total_mass(structure.beam());
}

std::string at_place_text(const std::optional<double>& position, const std::string& place) {
  if (!place.empty()) return " at " + place;
  return position ? fmt::format(" at {:g} m", *position) : "";
}

}  // namespace beamid::experiments
