#include "experiments/config/effective_keys.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "experiments/config/failure_response.hpp"
#include "experiments/config/key_tables.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

// Null where the key has none, where it has no use with what is given, or where that says the same otherwise.
Json default_beside(const Json& given, const std::string& selected, const Key& key, const KeyTable& section) {
  const auto is_given = [&](const std::string& name) { return given.contains(name); };
  const std::vector<std::string> rivals = section.rivals(key.name);
  const bool of_use =
      key.with.empty() || std::find(key.with.begin(), key.with.end(), selected) != key.with.end();
  if (!of_use || std::any_of(rivals.begin(), rivals.end(), is_given)) return nullptr;
  return std::visit(
      [](const auto& value) -> Json {
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, std::monostate>) return nullptr;
        if constexpr (std::is_same_v<Value, double>)
          if (!std::isfinite(value)) return nullptr;
        if constexpr (std::is_same_v<Value, std::string>)
          if (value.empty()) return nullptr;
        if constexpr (!std::is_same_v<Value, std::monostate>) return value;
      },
      key.preset);
}

std::string selected_in(const Json& given, const KeyTable& section) {
  if (given.contains(section.selector())) return given.at(section.selector());
  const Key* const selector = section.find(section.selector());
  const std::string* const preset = selector ? std::get_if<std::string>(&selector->preset) : nullptr;
  return preset ? *preset : "";
}

Json completed(const Json& given, const KeyTable& section, bool stands_once) {
  const auto value_of = [&](const Key& key) -> Json {
    const Json& value = given.at(key.name);
    const KeyTable* const inner =
        find_key_table(section.name().empty() ? key.name : section.name() + "." + key.name);
    if (inner == nullptr) return value;
    if (!value.is_array()) return completed(value, *inner, true);
    Json all = Json::array();
    for (const Json& one : value) all.push_back(completed(one, *inner, false));
    return all;
  };
  Json json = Json::object();
  const std::string selected = selected_in(given, section);
  for (const Key& key : section.keys())
    if (given.contains(key.name))
      json[key.name] = value_of(key);
    else if (stands_once)
      if (Json value = default_beside(given, selected, key, section); !value.empty())
        json[key.name] = std::move(value);
  for (const auto& [name, value] : given.items())  // options of the method chosen
    if (!json.contains(name)) json[name] = value;
  return json;
}

// A whole number as one, whatever type the option has.
Json option_value(const filters::OptionValue& value) {
  const double* const number = std::get_if<double>(&value);
  constexpr double largest = 0x1p53;
  if (number && std::abs(*number) <= largest && *number == std::floor(*number))
    return static_cast<std::int64_t>(*number);
  return std::visit([](const auto& held) { return Json(held); }, value);
}

Json list_of(const std::vector<Choice>& choices) {
  Json list = Json::array();
  for (const Choice& choice : choices) list.push_back(keys_of(choice, "method"));
  return list;
}

}  // namespace

Json effective_keys(const TomlTable& root, const std::vector<std::string>& also) {
  Json given = Json::parse(root.json());
  // A release has a place of its own on beams alone.
  const auto rules_out = [&](const std::string& table) {
    return table == "excitation" && (given.contains("excitations") || given.contains("frame") ||
                                     given.contains("space_frame") || given.contains("system"));
  };
  for (const std::string& table : also)
    if (!given.contains(table) && !rules_out(table)) given[table] = Json::object();
  return completed(given, *find_key_table(""), true);
}

Json effective_keys(const Experiment& experiment, const std::vector<std::string>& also) {
  if (!experiment.file) return Json::object();
  Json keys = effective_keys(*experiment.file, also);
  const auto choose = [&](const char* table, Json chosen) {
    if (!keys.contains(table)) return;
    for (const auto& [key, value] : keys[table].items())
      if (!chosen.contains(key) && find_key_table(table)->find(key) != nullptr) chosen[key] = value;
    keys[table] = std::move(chosen);
  };
  Json filter = keys_of(experiment.filter, "method");
  filter.update({{"discretisation", experiment.discretisation},
                 {"on_failure", to_string(experiment.on_failure)},
                 {"estimator", experiment.estimator}});
  if (!experiment.smoother.empty()) filter["smoother"] = experiment.smoother;
  choose("filter", std::move(filter));
  choose("model", keys_of(experiment.model, "name"));
  choose("reduction", keys_of(experiment.reduction, "method"));
  if (!experiment.reductions.empty()) keys["reductions"] = list_of(experiment.reductions);
  if (!experiment.filters.empty()) keys["filters"] = list_of(experiment.filters);
  if (!experiment.discretisations.empty()) {
    keys["compare"]["discretisations"] = experiment.discretisations;
    keys["compare"]["passes"] = experiment.passes;
  }
  if (const auto& window = experiment.format.window)
    keys["record"]["window_s"] = {window->first, window->second};
  return keys;
}

Json keys_of(const Choice& choice, const char* key) {
  Json json{{key, choice.name}};
  if (!choice.shape_file.empty()) json["shape_file"] = choice.shape_file;
  for (const auto& [option, value] : choice.options.values()) json[option] = option_value(value);
  return json;
}

}  // namespace beamid::experiments
