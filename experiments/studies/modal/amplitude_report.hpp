// How frequency and damping ratio depend on amplitude, as a user sees it.
#pragma once

#include "experiments/modal/study/merged_modes.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// A table `amplitude` (a few points of every mode of every record), a figure `amplitude_dependence` (all of
/// them, the records of a mode together, six modes at most), and all points under `amplitude_dependence`.
///
/// Amplitudes are those of the channel in which the mode is largest beside the channel's own size.
/// @throws std::invalid_argument when a record was not taken for a free decay.
void add_amplitude(const std::vector<RecordModes>& records, const std::vector<MergedMode>& merged,
                   Results& results);

}  // namespace beamid::experiments
