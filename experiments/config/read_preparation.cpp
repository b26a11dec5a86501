#include "experiments/config/read_preparation.hpp"

#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/text/method_choice.hpp"

namespace beamid::experiments {

std::vector<Choice> read_preparation(const TomlTable& record) {
  std::vector<Choice> steps;
  for (const TomlTable& table : record.find_tables("prepare")) {
    if (!table.contains("step")) table.miss("step", "a name from `beamid list steps`");
    const Choice choice = read_choice(table, "step", "", step_registry());
    at_place(choice.place, [&] {
      try {
        step_registry().make(choice.name, choice.options)->check();
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument("step '" + choice.name + "': " + error.what());
      }
    });
    steps.push_back(choice);
  }
  return steps;
}

}  // namespace beamid::experiments
