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

Json describe(const fem::MatrixSystem& system) {
  Json json{{"unknowns", system.labels},
            {"mass_entries", system.mass.nonZeros()},
            {"stiffness_entries", system.stiffness.nonZeros()},
            {"damping_entries", system.damping.nonZeros()}};
  for (const auto& parameter : system.parameters)
    json["parameters"].push_back({{"name", parameter.name}, {"value", parameter.value}});
  if (system.base_motion.size() > 0)
    json["base_motion"] = std::vector<double>(system.base_motion.begin(), system.base_motion.end());
  return json;
}

}  // namespace

std::string structure_text(const Experiment& experiment, Eigen::Index elements, Eigen::Index coordinates) {
  const fem::Structure& structure = experiment.structure;
  if (const fem::Frame* const frame = structure.frame())
    return frame_text(as_frame_experiment(*frame, experiment.elements, ""), coordinates) +
           factors_text(structure);
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
  if (const fem::Frame* const frame = structure.frame())
    return {{"frame", describe(as_frame_experiment(*frame, elements, ""))["frame"]}};
  if (const fem::SpaceFrame* const frame = structure.space_frame())
    return {{"space_frame", describe(*frame, elements)}};
  if (const fem::MatrixSystem* const matrices = structure.matrices())
    return {{"system", describe(*matrices)}};
  return {{"beam", describe(structure.beam(), elements)}};
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
