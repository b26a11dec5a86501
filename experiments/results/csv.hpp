// Fields of a comma-separated file.
#pragma once

#include <string>
#include <string_view>

namespace beamid::experiments {

/// A text, cleaned (clean_text.hpp), as one CSV field [rfc4180]: quoted where it holds a comma, a quote or a
/// line break.
std::string csv_field(std::string_view raw);

/// The shortest decimal number that reads back as the same double; empty when it is NaN.
std::string csv_field(double value);

/// Name of a column: "stiffness" in "N/m" is "stiffness_n_per_m", of no unit "stiffness".
std::string column_key(const std::string& name, const std::string& unit);

}  // namespace beamid::experiments
