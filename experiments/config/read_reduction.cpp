#include "experiments/config/read_reduction.hpp"

#include <algorithm>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/text/choice_text.hpp"

namespace beamid::experiments {
using filters::OptionValue;

namespace {

Schema<Choice> make_reduction_keys(const char* table, const char* fallback) {
  Schema<Choice> keys(table);
  return keys.with_options()
      .other("method", Key::Type::text, "a name from `beamid list reductions`", "\"modal_truncation\"")
      .fallback(fallback)
      .key("shape_file", &Choice::shape_file,
           "with `shape = \"given\"`: a text file of two columns, `position_m` and `deflection`, positions "
           "increasing; relative to this file's folder",
           "\"shape.csv\"")
      .fallback("none");
}

const KeyTable& reduction_keys() {
  static const Schema<Choice> keys = make_reduction_keys(
      "reduction",
      "`\"rayleigh\"`; for the models `beam` and `modal` `\"modal_truncation\"`, one exact mode; with "
      "`[[chain.storeys]]` `\"none\"`");
  return keys;
}

const KeyTable& compared_reduction_keys() {
  static const Schema<Choice> keys = make_reduction_keys("reductions", "`\"rayleigh\"`");
  return keys;
}

const bool reduction_keys_registered[] = {register_keys(reduction_keys),
                                          register_keys(compared_reduction_keys)};

}  // namespace

bool takes_shape(const Choice& choice) {
  return std::any_of(choice.options.values().begin(), choice.options.values().end(),
                     [](const auto& option) { return option.second == OptionValue(std::string("given")); });
}

void read_shape_file(const TomlTable& table, Choice& choice) {
  choice.shape_file = table.find_text("shape_file").value_or("");
  if (table.contains("shape_file") && choice.shape_file.empty())
    table.refuse("shape_file", "the name of a file");
  if (!takes_shape(choice))
    refuse_useless(table, {"shape_file"}, "without shape = \"given\"", "shape = \"given\"");
}

Choice read_reduction(const TomlTable& table) {
  Choice choice =
      read_choice(table, "method", "rayleigh", reduction::reduction_registry(), reduction_keys().names());
  if (choice.place.line == 0) choice.place = table.place();
  read_shape_file(table, choice);
  return choice;
}

Choice parse_reduction(const std::string& text, const std::string& origin) {
  const auto& registry = reduction::reduction_registry();
  return at_place(Place{origin}, [&] {
    ChoiceWords words = split_choice(text);
    Choice choice{words.name, {}, {origin}};
    registry.find(choice.name);
    const auto shape = std::find_if(words.options.begin(), words.options.end(),
                                    [](const auto& word) { return word.first == "shape_file"; });
    if (shape != words.options.end()) {
      choice.shape_file = shape->second;
      words.options.erase(shape);
    }
    const filters::Options options = parse_options(words, registry);
    registry.make(choice.name, options);
    choice.options = registry.completed(choice.name, options);
    if (!choice.shape_file.empty() && !takes_shape(choice))
      throw std::invalid_argument("shape_file has no use with reduction '" + choice.name +
                                  "' as it is; expected shape=given");
    return choice;
  });
}

std::string to_text(const Choice& choice) {
  return choice_text(choice, reduction::reduction_registry().find(choice.name).options);
}

}  // namespace beamid::experiments
