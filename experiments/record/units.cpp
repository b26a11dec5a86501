#include "experiments/record/units.hpp"

#include <algorithm>
#include <map>

namespace beamid::experiments {

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

}  // namespace beamid::experiments
