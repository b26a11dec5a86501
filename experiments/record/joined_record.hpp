// One record from several files, a sensor or more each.
#pragma once

#include "experiments/record/record_format.hpp"

namespace beamid::experiments {

/// Reads the channels of each of the format's files and joins them by their stamps. The part that all files
/// have in common is kept, at the stamps of the file that is sampled fastest: others that lie between those
/// are brought there by band-limited interpolation (interpolation.hpp), and remarks name them. Files whose
/// stamps have less than half of the shorter one in common have no common clock: each is counted from its own
/// beginning, and Record::own_clock names the channels of all but the first.
/// @throws InputError as read_record(), and where a file that has to be interpolated lacks readings.
Record joined_record(const RecordFormat& format);

}  // namespace beamid::experiments
