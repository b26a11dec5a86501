// The part of a record that a modal analysis can use.
#pragma once

#include <string>
#include <vector>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

/// Channels that move: forces are no response.
/// @throws std::invalid_argument when there is none.
Record motion_of(const Record& record);

/// The longest part in which every channel has all its readings (missing ones, NaN, are those of a clipped
/// sensor or a drop-out); what was left out is a sentence of `remarks`.
/// @throws std::invalid_argument when no part has 64 samples, with the place.
Record complete_part(const Record& record, std::vector<std::string>& remarks);

/// From the largest reading on, relative to each channel's own size.
Record from_release(const Record& record, std::vector<std::string>& remarks);

/// @throws std::invalid_argument unless the intervals are equal within 20 %.
void check_intervals(const Record& record);

}  // namespace beamid::experiments
