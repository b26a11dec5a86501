// One sample in one line.
#pragma once

#include <string>

#include "experiments/text/input_error.hpp"
#include "filters/running_filter.hpp"

namespace beamid::experiments {

/// "time,output[,output...]" [s, SI]; an output that is empty or "nan" was not measured.
/// @param place of the line; the column is told by this.
/// @throws InputError naming line and column, what was found and what was expected.
filters::Sample read_sample(const std::string& line, Eigen::Index outputs, const Place& place);

}  // namespace beamid::experiments
