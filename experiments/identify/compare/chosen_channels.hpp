// What some of a record's channels would have shown.
#pragma once

#include "experiments/identify/compare/comparison.hpp"

namespace beamid::experiments {

/// The record with these channels of motion only, in its own order; measured forces stay.
/// @throws std::invalid_argument when a name is no channel of motion, or several have it.
ComparedRecord chosen_channels(ComparedRecord compared, const std::vector<std::string>& names);

/// Likewise, of its channels those that are kept (one for each), with what is known of each.
ComparedRecord with_channels(ComparedRecord compared, const std::vector<bool>& kept);

}  // namespace beamid::experiments
