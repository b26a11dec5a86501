// The choice of a registered method: in a file, on the command line, and as a text.
#pragma once

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "experiments/text/input_error.hpp"
#include "experiments/text/toml_table.hpp"
#include "filters/registry.hpp"

namespace beamid::experiments {

/// A registered method and its options, chosen by name.
struct Choice {
  std::string name;
  filters::Options options;
  Place place = {};  ///< where it was chosen, for messages; empty when it was not
  std::string shape_file =
      {};  ///< of a reduction that takes a given shape; relative to the TOML file's folder; empty: none
};

// The choice of a registered method, checked while its place in the file is known.

/// Turns a library's std::invalid_argument into an InputError at `place`.
template <class Action>
auto at_place(const Place& place, Action action) {
  try {
    return action();
  } catch (const std::invalid_argument& error) {
    throw InputError(place, error.what());
  }
}

/// Reads `method = "ukf"` and the options beside it from a table such as [filter].
///
/// A method that needs nothing but options is made once, so that it checks their values.
/// @param key of the method's name; absent: `fallback`.
/// @param others keys of the table that are no options.
/// @returns the choice with every option of the method, those not given at their defaults.
/// @throws InputError "unknown filter 'ufk'; known: ekf, ukf" at the name, or at the key of a bad option.
template <class Registry>
Choice read_choice(const TomlTable& table, const std::string& key, const std::string& fallback,
                   const Registry& registry, const std::vector<std::string>& others = {}) {
  Choice choice{table.find_text(key).value_or(fallback), {}, table.value_place(key)};
  at_place(choice.place, [&] { registry.find(choice.name); });
  for (const std::string& option : table.keys()) {
    if (option == key || std::find(others.begin(), others.end(), option) != others.end()) continue;
    const auto value = table.find_value(option);
    at_place(table.key_place(option), [&] {
      const filters::Options only{{option, *value}};
      registry.completed(choice.name, only);
      if constexpr (requires { registry.make(choice.name, only); }) registry.make(choice.name, only);
    });
    choice.options.set(option, *value);
  }
  choice.options = registry.completed(choice.name, choice.options);
  return choice;
}

// A method and its options as a word of the command line: "modal_truncation:modes=3".

// Words of the command line and of short texts, taken apart.

/// The parts between separators, empty ones included; at least one.
std::vector<std::string> split(const std::string& text, char separator);

/// A word that is a finite number as a whole; nothing else, not even a blank.
std::optional<double> number(const std::string& word);

/// A value as the user would write it; a number as the shortest that reads back the same, those of a list
/// parted by "/".
std::string word_of(const filters::OptionValue& value);

/// "guyan:masters_m=0.4/0.8" taken apart: name, then option and value in their order.
struct ChoiceWords {
  std::string name;
  std::vector<std::pair<std::string, std::string>> options;
};

/// @throws std::invalid_argument where a word after the colon is no OPTION=VALUE.
ChoiceWords split_choice(const std::string& text);

/// A word in the type that the option has; the numbers of a list are parted by "/".
/// @param owner reads like "filter 'ukf'". @throws std::invalid_argument
filters::OptionValue parse_value(const std::string& word, const filters::OptionSpec& option,
                                 const std::string& owner);

/// The words as options; a name that no option has stays a text, for the registry to refuse.
template <class Registry>
filters::Options parse_options(const ChoiceWords& words, const Registry& registry) {
  const auto& specs = registry.find(words.name).options;
  filters::Options options;
  for (const auto& word : words.options) {
    const auto spec = std::find_if(specs.begin(), specs.end(),
                                   [&](const auto& candidate) { return candidate.name == word.first; });
    options.set(word.first, spec == specs.end()
                                ? filters::OptionValue(word.second)
                                : parse_value(word.second, *spec, registry.kind() + " '" + words.name + "'"));
  }
  return options;
}

/// @param origin stands for the place in messages: "--filter".
/// @throws InputError on an unknown name, or a bad option.
template <class Registry>
Choice parse_choice(const std::string& text, const std::string& origin, const Registry& registry) {
  return at_place(Place{origin}, [&] {
    const ChoiceWords words = split_choice(text);
    return Choice{words.name, registry.completed(words.name, parse_options(words, registry)), {origin}};
  });
}

/// The same text again, without the options that are at their fallbacks.
std::string choice_text(const Choice& choice, const std::vector<filters::OptionSpec>& specs);

}  // namespace beamid::experiments
