// The choice of a registered method, as a user's file states it.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
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

}  // namespace beamid::experiments
