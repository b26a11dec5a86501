// What a single identification of a record is worth, beside what else is known of the record.
#pragma once

#include "experiments/identify/compare/comparison.hpp"

namespace beamid::experiments {

/// Judges every run of a comparison that converged, as `identify` reports it:
///
/// - Intervals are widened where the noise at the record's mode is denser than white noise of the deviation
/// that
///   the filter assumes (noise_near_mode.hpp); they are never narrowed.
/// - A warning where the first mode at the estimate and the modal analysis of the first channel differ by
/// more
///   than three of their standard deviations together, in frequency or in damping ratio, with how much.
/// - A warning where the innovations are not those of a consistent filter.
///
/// Records driven by a measured force have no modal analysis, models that are not linear no mode: of the
/// three, the last.
void judge_runs(Comparison& comparison);

}  // namespace beamid::experiments
