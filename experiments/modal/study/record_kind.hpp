// What a record is, by its inputs: which method of modal analysis suits it.
#pragma once

#include "experiments/record/record.hpp"

namespace beamid::experiments {

/// Whether its only input is a force that rests but for two hits of a hammer or more: four fifths of its
/// samples below a twentieth of its largest.
bool is_struck(const Record& record);

/// Whether an input was measured, of a base or a force, that acts for a part of the record: a thirtieth of
/// its samples above a twentieth of its largest. A single hit does not.
bool is_driven(const Record& record);

}  // namespace beamid::experiments
