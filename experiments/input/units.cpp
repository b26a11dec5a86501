#include "experiments/input/units.hpp"

#include <algorithm>

namespace beamid::experiments {

const std::vector<Unit>& units(Quantity quantity) {
  static const std::vector<Unit> displacement{{"m", "m", 1}, {"mm", "mm", 1e-3}, {"um", "um", 1e-6}};
  static const std::vector<Unit> velocity{{"m/s", "m_per_s", 1}, {"mm/s", "mm_per_s", 1e-3}};
  static const std::vector<Unit> acceleration{
      {"m/s2", "m_per_s2", 1}, {"mm/s2", "mm_per_s2", 1e-3}, {"g", "g", standard_gravity}};
  static const std::vector<Unit> force{{"N", "n", 1}, {"kN", "kn", 1e3}};
  static const std::vector<Unit> strain{{"m/m", "m_per_m", 1}, {"um/m", "um_per_m", 1e-6}};
  switch (quantity) {
    case Quantity::displacement:
      return displacement;
    case Quantity::velocity:
      return velocity;
    case Quantity::acceleration:
      return acceleration;
    case Quantity::strain:
      return strain;
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

std::vector<std::string> symbols(const std::vector<Unit>& units) {
  std::vector<std::string> result;
  for (const Unit& unit : units) result.push_back(unit.symbol);
  return result;
}

}  // namespace beamid::experiments
