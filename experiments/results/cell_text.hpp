// One cell of a table as text.
#pragma once

#include <string>

#include "experiments/results/table.hpp"

namespace beamid::experiments {

/// A text as it is, a number in its column's format, without a sign where that is a zero, NaN as "-".
/// @throws std::invalid_argument when the format does not suit a number.
std::string cell_text(const Column& column, const Cell& cell);

}  // namespace beamid::experiments
