// Column names that carry their unit: time_s, acceleration_g, displacement_root_mm.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
