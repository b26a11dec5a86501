#include "experiments/config/read_preparation.hpp"

#include "experiments/config/key_tables.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/text/method_choice.hpp"

namespace beamid::experiments {
namespace {

const KeyTable& step_keys() {
  static const Schema<Choice> keys =
      Schema<Choice>("record.prepare")
          .with_options()
          .other("step", Key::Type::text, "a name from `beamid list steps`", "\"high_pass\"")
          .required("a name from `beamid list steps`");
  return keys;
}

const bool step_keys_registered = register_keys(step_keys);

}  // namespace

std::vector<Choice> read_preparation(const TomlTable& record) {
  std::vector<Choice> steps;
  for (const TomlTable& table : record.find_tables("prepare")) {
    if (!table.contains("step")) table.miss("step", step_keys().find("step")->missing);
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
