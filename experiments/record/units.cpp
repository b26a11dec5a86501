#include "experiments/record/units.hpp"

#include <algorithm>
#include <map>

#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

/// @param start "acceleration"; @param known its units.
std::optional<ColumnMeaning> parse_as(std::string_view name, std::string_view start,
                                      const std::vector<Unit>& known) {
  if (!name.starts_with(start)) return std::nullopt;
  name.remove_prefix(start.size());
  for (const Unit& unit : known) {
    const std::string end = "_" + unit.suffix;
    if (!name.ends_with(end)) continue;
    name.remove_suffix(end.size());
    if (!name.empty() && (name.front() != '_' || name.size() == 1)) return std::nullopt;
    return ColumnMeaning{std::nullopt, std::string(name.empty() ? name : name.substr(1)), unit.factor};
  }
  return std::nullopt;
}

/// The channel's name as a label: "Tip acceleration, x" -> "tip_x".
std::string label(const Channel& channel) {
  if (const auto meaning = parse_column_name(channel.name)) return meaning->label;
  std::string words;
  for (const char letter : channel.name) {
    const bool lower = letter >= 'a' && letter <= 'z', upper = letter >= 'A' && letter <= 'Z';
    const bool digit = letter >= '0' && letter <= '9';
    if (lower || upper || digit)
      words += upper ? static_cast<char>(letter - 'A' + 'a') : letter;
    else if (!words.empty() && words.back() != '_')
      words += '_';
  }
  const std::string quantity = to_string(channel.quantity);
  if (const std::size_t at = words.find(quantity); at != std::string::npos) words.erase(at, quantity.size());
  words.erase(std::unique(words.begin(), words.end(), [](char a, char b) { return a == '_' && b == '_'; }),
              words.end());
  if (!words.empty() && words.front() == '_') words.erase(0, 1);
  if (!words.empty() && words.back() == '_') words.pop_back();
  return words;
}

}  // namespace

std::optional<ColumnMeaning> parse_column_name(std::string_view name) {
  for (const char* start : {"time", "t"})
    if (auto time = parse_as(name, start, time_units()); time && time->label.empty()) return time;
  for (const Quantity quantity : all_quantities)
    if (auto meaning = parse_as(name, to_string(quantity), units(quantity))) {
      meaning->quantity = quantity;
      return meaning;
    }
  return std::nullopt;
}

std::vector<std::string> column_names(const Record& record) {
  std::vector<std::string> names{"time_s"};
  for (const Channel& channel : record.channels) {
    const std::string middle = label(channel), start = to_string(channel.quantity);
    const std::string end = "_" + units(channel.quantity).front().suffix;
    std::string name = start + (middle.empty() ? "" : "_" + middle) + end;
    for (int copy = 2; std::find(names.begin(), names.end(), name) != names.end(); ++copy)
      name = start + (middle.empty() ? "" : "_" + middle) + "_" + std::to_string(copy) + end;
    names.push_back(std::move(name));
  }
  return names;
}

std::string quantity_key(Quantity quantity) {
  return std::string(to_string(quantity)) + "_" + units(quantity).front().suffix;
}

std::string known_column_names() {
  std::vector<std::string> names;
  for (const Unit& unit : time_units()) names.push_back("time_" + unit.suffix);
  for (const Quantity quantity : all_quantities)
    for (const Unit& unit : units(quantity))
      names.push_back(std::string(to_string(quantity)) + "_" + unit.suffix);
  return joined(names);
}

const std::vector<Unit>& units(Quantity quantity) {
  static const std::vector<Unit> displacement{{"m", "m", 1}, {"mm", "mm", 1e-3}, {"um", "um", 1e-6}};
  static const std::vector<Unit> velocity{{"m/s", "m_per_s", 1}, {"mm/s", "mm_per_s", 1e-3}};
  static const std::vector<Unit> acceleration{
      {"m/s2", "m_per_s2", 1}, {"mm/s2", "mm_per_s2", 1e-3}, {"g", "g", standard_gravity}};
  static const std::vector<Unit> force{{"N", "n", 1}, {"kN", "kn", 1e3}};
  static const std::vector<Unit> strain{{"m/m", "m_per_m", 1}, {"um/m", "um_per_m", 1e-6}};
  static const std::vector<Unit> angular{{"rad/s2", "rad_per_s2", 1}, {"mrad/s2", "mrad_per_s2", 1e-3}};
  switch (quantity) {
    case Quantity::displacement:
      return displacement;
    case Quantity::velocity:
      return velocity;
    case Quantity::acceleration:
    case Quantity::base_acceleration:
    case Quantity::support_acceleration:
      return acceleration;
    case Quantity::strain:
      return strain;
    case Quantity::angular_acceleration:
    case Quantity::support_angular_acceleration:
      return angular;
    case Quantity::force:
      break;
  }
  return force;
}

const std::vector<Unit>& time_units() {
  static const std::vector<Unit> time{{"s", "s", 1}, {"ms", "ms", 1e-3}, {"us", "us", 1e-6}};
  return time;
}

std::optional<Quantity> find_quantity(std::string_view name) {
  const auto* const quantity = std::find_if(std::begin(all_quantities), std::end(all_quantities),
                                            [&](Quantity q) { return to_string(q) == name; });
  return quantity == std::end(all_quantities) ? std::nullopt : std::optional(*quantity);
}

namespace {

/// Without brackets, blanks, '^', '*' and a raised two.
std::string plain(std::string_view spelling) {
  std::string text(spelling);
  for (const std::string_view raised : {"\u00b2", "\xb2"})
    for (std::size_t at; (at = text.find(raised)) != std::string::npos;) text.replace(at, raised.size(), "2");
  for (const std::string_view micro : {"\u00b5", "\u03bc", "\xb5"})
    for (std::size_t at; (at = text.find(micro)) != std::string::npos;) text.replace(at, micro.size(), "u");
  text.erase(std::remove_if(text.begin(), text.end(),
                            [](char c) {
                              return c == ' ' || c == '[' || c == ']' || c == '(' || c == ')' || c == '^' ||
                                     c == '*';
                            }),
             text.end());
  return text;
}

}  // namespace

std::optional<StatedUnit> stated_unit(std::string_view spelling) {
  static const std::map<std::string, std::string> others{
      {"m/sec2", "m/s2"}, {"m/s/s", "m/s2"}, {"mm/sec2", "mm/s2"}, {"m/sec", "m/s"},
      {"mm/sec", "mm/s"}, {"newton", "N"},   {"Newton", "N"},      {"Newtons", "N"},
      {"meter", "m"},     {"metre", "m"},    {"Meter", "m"},       {"gn", "g"},
      {"sec", "s"},       {"Sec", "s"},      {"second", "s"},      {"seconds", "s"},
      {"Seconds", "s"},   {"msec", "ms"},    {"ustrain", "um/m"},  {"microstrain", "um/m"},
      {"ue", "um/m"},     {"strain", "m/m"}, {"ms-2", "m/s2"},     {"ms-1", "m/s"}};
  std::string symbol = plain(spelling);
  if (const auto other = others.find(symbol); other != others.end()) symbol = other->second;
  for (const Unit& unit : time_units())
    if (unit.symbol == symbol) return StatedUnit{std::nullopt, unit.factor};
  for (const Quantity quantity : all_quantities)
    for (const Unit& unit : units(quantity))
      if (unit.symbol == symbol || unit.suffix == symbol) return StatedUnit{quantity, unit.factor};
  return std::nullopt;
}

std::vector<std::string> symbols(const std::vector<Unit>& units) {
  std::vector<std::string> result;
  for (const Unit& unit : units) result.push_back(unit.symbol);
  return result;
}

std::optional<double> unit_factor(std::string_view symbol, std::optional<Quantity> quantity) {
  for (const Unit& unit : quantity ? units(*quantity) : time_units())
    if (unit.symbol == symbol) return unit.factor;
  return convertible_unit(symbol, quantity);
}

}  // namespace beamid::experiments
