// One channel of a file that is inspected.
#pragma once

#include "experiments/record/inspect/inspection.hpp"
#include "experiments/record/record_columns.hpp"

namespace beamid::experiments {

/// The column's samples, in SI units where its quantity is stated.
/// @param described by the experiment file; nullptr: not
InspectedChannel make_channel(const RecordTable& table, std::size_t index,
                              const ColumnDescription* described);

/// Defects, noise, frequency and events of the channel's samples at the instants found.
void inspect_channel(const Inspection& found, InspectedChannel& channel);

}  // namespace beamid::experiments
