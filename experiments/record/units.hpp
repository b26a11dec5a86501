// The units a record may be written in.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

/// A unit of one quantity.
struct Unit {
  std::string symbol;  ///< as in a configuration: "mm/s2"
  std::string suffix;  ///< as in a column's name: "mm_per_s2"
  double factor;       ///< times a value in this unit gives the value in the SI unit
};

/// Standard acceleration of gravity [m/s2], exact by definition.
inline constexpr double standard_gravity = 9.80665;

/// Units of a quantity; the first one is the SI unit.
const std::vector<Unit>& units(Quantity quantity);

/// s, ms, us.
const std::vector<Unit>& time_units();

/// Those that files name.
inline constexpr Quantity all_quantities[] = {Quantity::displacement,
                                              Quantity::velocity,
                                              Quantity::acceleration,
                                              Quantity::force,
                                              Quantity::strain,
                                              Quantity::base_acceleration,
                                              Quantity::support_acceleration,
                                              Quantity::angular_acceleration};

/// The quantity of that name: "acceleration".
std::optional<Quantity> find_quantity(std::string_view name);

/// What a unit says that a file names in its own spelling: "m/s^2", "m/s**2", "(g)", "Newton".
struct StatedUnit {
  std::optional<Quantity> quantity;  ///< absent: time
  double factor = 1;                 ///< to the SI unit
};

/// Nothing for a spelling that does not tell a quantity of a record, such as "V" or "deg".
std::optional<StatedUnit> stated_unit(std::string_view spelling);

/// Symbols, for messages and checks.
std::vector<std::string> symbols(const std::vector<Unit>& units);

}  // namespace beamid::experiments
