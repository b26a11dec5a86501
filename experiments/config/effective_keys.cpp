#include "experiments/config/effective_keys.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace

Json effective_keys(const TomlTable& root, const std::vector<std::string>& also) {
  Json given = Json::parse(root.json());
  for (const std::string& table : also)
    if (!given.contains(table)) given[table] = Json::object();
  return completed(given, *find_key_table(""), true);
}

}  // namespace beamid::experiments
