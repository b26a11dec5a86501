// The units a record may be written in.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

// Column names that carry their unit: time_s, acceleration_g, displacement_root_mm.

/// What a column's name says.
struct ColumnMeaning {
  std::optional<Quantity> quantity;  ///< absent: time
  std::string label;                 ///< between quantity and unit: "root"; may be empty
  double factor = 1;                 ///< to SI units
};

/// Reads `quantity[_label]_unit`, where the unit is written as in "m_per_s2"; nothing when the name is
/// another.
std::optional<ColumnMeaning> parse_column_name(std::string_view name);

/// The names a record's file gives its columns, time first, in SI units and all different; each one is read
/// back by parse_column_name(). A channel's name becomes the label: letters and digits, lower case, without
/// the quantity.
std::vector<std::string> column_names(const Record& record);

/// "acceleration_m_per_s2": the quantity in SI units, as columns and keys have it.
std::string quantity_key(Quantity quantity);

/// "time_s, displacement_m, ..." for messages: the names without labels.
std::string known_column_names();

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

/// Of times, in any spelling: "ns", "minutes", "microseconds since 2026-11-26 10:00:00" [s].
std::optional<double> unit_of_times(std::string_view written);

/// Nothing for a spelling that does not tell a quantity of a record, such as "V" or "deg".
std::optional<StatedUnit> stated_unit(std::string_view spelling);

// Units of the world beside those above.

/// What a value in a unit of any spelling is multiplied by to be in the SI unit of a quantity, by UDUNITS-2
/// [udunits]: "in/s^2", "cm s-2", "gal", "lbf", "km/h", "hr". To be used only where the table has no such
/// unit and the spelling stands where a unit stands.
///
/// @param quantity that is known already; absent: time
/// @returns nothing where the library is missing, or where the spelling is no unit of that quantity; where it
/// has an offset, a number of its own ("10 mm"), or a size that no record of the quantity has; or where it is
/// a word that a column's name has for something else ("rod", "foot", "force"). Gravity is in the table.
std::optional<double> convertible_unit(std::string_view spelling, std::optional<Quantity> quantity);

/// The factor to the SI unit of a symbol of the table, else of a convertible unit; nothing where it is
/// neither.
/// @param quantity absent: time
std::optional<double> unit_factor(std::string_view symbol, std::optional<Quantity> quantity);

/// "s", "ms", "min" of so many seconds.
std::string symbol_of_time(double factor);

/// Symbols, for messages and checks.
std::vector<std::string> symbols(const std::vector<Unit>& units);

}  // namespace beamid::experiments
