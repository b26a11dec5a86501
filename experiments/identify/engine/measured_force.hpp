// Whether a record knows the scale of masses.
#pragma once

#include <algorithm>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

/// Whether a force was measured. Without one, motion knows stiffness and damping over mass alone.
inline bool measures_force(const Record& record) {
  return std::any_of(record.channels.begin(), record.channels.end(),
                     [](const Channel& channel) { return channel.quantity == Quantity::force; });
}

/// What that makes of masses that are described and asked about nowhere: the end of a sentence.
inline constexpr const char* of_unweighed_masses =
    "masses described 1 % too large make every stiffness and dashpot 1 % too large, and no interval counts "
    "that.";

}  // namespace beamid::experiments
