// A measured input that a part of the record lacks.
#pragma once

#include <string>

#include "experiments/record/record_format.hpp"

namespace beamid::experiments {

/// Cuts the record to the longest stretch in which every input is known, or takes inputs as 0 where they are
/// not. @returns what was done, in a sentence; empty: nothing had to be, or the readings are left missing,
/// which what needs them refuses.
/// @throws std::invalid_argument when no stretch holds 16 samples.
std::string take_known_inputs(Record& record, MissingInput how);

}  // namespace beamid::experiments
