#include "experiments/config/storey_laws.hpp"

#include <fmt/format.h>

namespace beamid::experiments {

std::string storey_laws_text(const std::vector<StoreySpring>& springs) {
  std::string text;
  for (const StoreySpring& spring : springs)
    text += fmt::format("{}storey {} {}", text.empty() ? "" : ", ", spring.storey, spring.law.name);
  return text;
}

std::string small_motion_note(const Experiment& experiment) {
  if (experiment.storey_springs.empty()) return {};
  return fmt::format(
      "This is the small motion about rest, each storey a linear spring of its stiffness there: {} {} "
      "its law only where it moves more.",
      storey_laws_text(experiment.storey_springs),
      experiment.storey_springs.size() == 1 ? "follows" : "each follow");
}

void require_model_of_storeys(const Experiment& experiment) {
  if (experiment.storey_springs.empty() || experiment.model.name == "beam") return;
  throw InputError(
      experiment.model.place,
      fmt::format("model '{}' is linear or of one coordinate; storeys that follow laws ({}) are moved by "
                  "model beam. Expected [model] name = \"beam\"",
                  experiment.model.name, storey_laws_text(experiment.storey_springs)));
}

void require_linear_storeys(const Experiment& experiment, const std::string& command) {
  if (experiment.storey_springs.empty()) return;
  throw InputError(
      experiment.storey_springs.front().law.place,
      fmt::format("{} takes linear storeys only; found {}. Expected no [[chain.storeys]], or simulate, "
                  "identify, compare or identifiability, which take them",
                  command, storey_laws_text(experiment.storey_springs)));
}

}  // namespace beamid::experiments
