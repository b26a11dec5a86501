// What a row of a schema says to people: units, defaults, what a value may be.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/config/key_tables.hpp"
#include "experiments/text/choice.hpp"

namespace beamid::experiments {
namespace {

using Type = Key::Type;

std::string number_values(const Range& range) {
  if (range.greater_than != nullptr) return fmt::format("number above `{}`", range.greater_than);
  if (range.on_beam) return "number, 0 to length";
  if (!std::isfinite(range.least)) return "number";
  if (!std::isfinite(range.most)) return range.above ? "number > 0" : "number >= 0";
  if (!range.above && !range.below) return fmt::format("number, {:g} to {:g}", range.least, range.most);
  return fmt::format("number, {:g} {} value {} {:g}", range.least,
                     range.above ? "<" : "<=", range.below ? "<" : "<=", range.most);
}

std::string list_text(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) text += fmt::format("{}{:g}", text.empty() ? "" : ", ", number);
  return "[" + text + "]";
}

}  // namespace

std::string unit_in_key(const std::string& key) {
  static const std::map<std::string, std::string> symbols{
      {"m", "m"}, {"m2", "m2"}, {"m3", "m3"}, {"kg", "kg"},   {"s", "s"},  {"s2", "s2"},
      {"n", "N"}, {"pa", "Pa"}, {"hz", "Hz"}, {"rad", "rad"}, {"per", "/"}};
  std::vector<std::string> parts = split(key, '_');
  const auto begin = std::find_if(parts.rbegin(), parts.rend(), [](const std::string& part) {
                       return !symbols.contains(part);
                     }).base();
  std::string unit;
  for (auto part = begin; part != parts.end(); ++part) {
    const std::string& symbol = symbols.at(*part);
    const bool joins = symbol == "/" || unit.empty() || unit.ends_with('/');
    unit += (joins ? "" : " ") + symbol;
  }
  return unit.starts_with('/') ? "1" + unit : unit;
}

std::string default_text(const KeyValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("`{:g}`", *number);
  if (const auto* number = std::get_if<int>(&value)) return fmt::format("`{}`", *number);
  if (const auto* truth = std::get_if<bool>(&value)) return *truth ? "`true`" : "`false`";
  if (const auto* text = std::get_if<std::string>(&value)) return "`\"" + *text + "\"`";
  if (const auto* pair = std::get_if<std::pair<double, double>>(&value))
    return "`" + list_text({pair->first, pair->second}) + "`";
  return "none";
}

std::string values_text(const Key& key) {
  if (!key.values.empty()) return key.values;
  switch (key.type) {
    case Type::number:
      return number_values(key.range);
    case Type::whole:
      return fmt::format("whole number, {:.0f} to {:.0f}", key.range.least, key.range.most);
    case Type::truth:
      return "`true`, `false`";
    case Type::text: {
      std::string text;
      for (const std::string& one : key.allowed) text += (text.empty() ? "`\"" : ", `\"") + one + "\"`";
      return text.empty() ? "text" : text;
    }
    case Type::texts:
      return "texts";
    case Type::numbers:
      return key.range.least == 0.0 ? "numbers >= 0" : "numbers";
    case Type::interval:
      return "two numbers";
    case Type::column:
      return "whole number >= 1 or text";
    case Type::table:
      return "table";
    case Type::tables:
      break;
  }
  return "tables";
}

std::string heading_of(const KeyTable& section) {
  if (section.name().empty()) return "The file itself";
  const std::size_t dot = section.name().rfind('.');
  const KeyTable* const outer = find_key_table(dot == std::string::npos ? "" : section.name().substr(0, dot));
  const Key* const key = outer ? outer->find(section.name().substr(dot + 1)) : nullptr;
  const bool array = key != nullptr && key->type == Type::tables;
  return (array ? "[[" : "[") + section.name() + (array ? "]]" : "]");
}

}  // namespace beamid::experiments
