// One cell of a table as text.
#pragma once

#include <string>

#include "experiments/results/table.hpp"

namespace beamid::experiments {

/// With two digits of its uncertainty, "3.4555" of 3.45549 +- 0.00023, at most twelve decimals, and with six
/// digits where that is not known; with an exponent where it is very large or small; NaN as "-".
std::string rounded_text(const Rounded& number);

/// A text as it is, a rounded number likewise, a number in its column's format, without a sign where that is
/// a zero, NaN as "-".
/// @throws std::invalid_argument when the format does not suit a number.
std::string cell_text(const Column& column, const Cell& cell);

}  // namespace beamid::experiments
