#include "apps/python/module.hpp"

#include <nlohmann/json.hpp>

#include "apps/command.hpp"
#include "experiments/config/key_tables.hpp"
#include "experiments/record/units.hpp"

namespace beamid::python {
namespace {

using Json = nlohmann::ordered_json;
using experiments::Key, experiments::KeyTable;

const char* type_name(apps::Option::Type type) {
  switch (type) {
    case apps::Option::Type::flag:
      return "flag";
    case apps::Option::Type::text:
      return "text";
    case apps::Option::Type::number:
      return "number";
    default:
      return "whole";
  }
}

Json option_json(const apps::Option& option, const std::string& group) {
  return {{"name", option.name},
          {"group", group},
          {"value", option.value},
          {"help", apps::described(option)},
          {"type", type_name(option.type)},
          {"values", option.values},
          {"repeats", option.repeats},
          {"required", option.required},
          {"choices", option.choices}};
}

Json command_json(const apps::Command& command, const std::string& group) {
  Json words = Json::array(), options = Json::array();
  for (const apps::Argument& word : command.words)
    words.push_back({{"name", word.name}, {"several", word.several}, {"required", word.required}});
  bool has_results = false;
  for (const apps::OptionGroup& one : command.options)
    for (const apps::Option& option : one.options) {
      options.push_back(option_json(option, one.title));
      has_results = has_results || option.name == "json";
    }
  return {{"name", command.name},      {"group", group}, {"summary", command.summary},
          {"notes", command.notes},    {"words", words}, {"options", options},
          {"has_results", has_results}};
}

const char* type_name(Key::Type type) {
  switch (type) {
    case Key::Type::number:
      return "number";
    case Key::Type::whole:
      return "whole";
    case Key::Type::truth:
      return "truth";
    case Key::Type::text:
      return "text";
    case Key::Type::texts:
      return "texts";
    case Key::Type::numbers:
      return "numbers";
    case Key::Type::interval:
      return "interval";
    case Key::Type::column:
      return "column";
    case Key::Type::table:
      return "table";
    default:
      return "tables";
  }
}

Json table_json(const KeyTable& table) {
  Json keys = Json::array();
  for (const Key& key : table.keys())
    keys.push_back({{"name", key.name},
                    {"type", type_name(key.type)},
                    {"unit", experiments::unit_in_key(key.name)},
                    {"values", key.is_table() ? "" : experiments::values_text(key)},
                    {"meaning", key.meaning},
                    {"default", key.fallback}});
  return {{"name", table.name()}, {"has_options", table.has_options()}, {"keys", keys}};
}

Json units_json(const std::vector<experiments::Unit>& units) {
  Json all = Json::array();
  for (const experiments::Unit& unit : units)
    all.push_back({{"symbol", unit.symbol}, {"suffix", unit.suffix}});
  return all;
}

}  // namespace

std::string specification() {
  Json all;
  all["version"] = BEAMID_VERSION;
  for (const apps::CommandGroup& group : apps::command_groups())
    for (const apps::Command& command : group.commands)
      all["commands"].push_back(command_json(command, group.title));
  for (const KeyTable* table : experiments::key_tables()) all["tables"].push_back(table_json(*table));
  for (const experiments::Quantity quantity : experiments::all_quantities)
    all["quantities"][experiments::to_string(quantity)] = units_json(experiments::units(quantity));
  all["time_units"] = units_json(experiments::time_units());
  return all.dump();
}

}  // namespace beamid::python
