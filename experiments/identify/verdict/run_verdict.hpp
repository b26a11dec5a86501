// What a single identification of a record is worth, beside what else is known of the record.
#pragma once

#include "experiments/identify/engine/compared_run.hpp"

namespace beamid::experiments {

constexpr double settled_move = 1.0;  ///< of an unknown by the last pass, at most, in standard deviations

/// Status, intervals and warnings of a run, the same whatever command asked for it.
///
/// - Intervals are widened where the noise at the record's mode is denser than white noise of the deviation
///   that the filter assumes (noise_near_mode.hpp), or where a free decay varies with its amplitude
///   (amplitude_sections.hpp); they are never narrowed.
/// - K and C of a free decay: record_identification.hpp.
/// - Of any other model, a warning where its first mode at the estimate and the modal analysis of the first
///   channel differ by more than three of their standard deviations together, in frequency or in damping
///   ratio, with how much; one where the reduction moves the mode (run_verdict.cpp); and one where the
///   innovations are not those of a consistent filter. A filter that diverged is said to have.
///
/// Records driven by a measured force have no modal analysis, models that are not linear no mode: of the
/// three, the last.
void judge_run(const RunContext& context, ComparedRun& run);

/// A warning where the deviation of a parameter asked about, no nuisance, is nearly the one assumed
/// beforehand.
void judge_what_is_said(ComparedRun& run);

}  // namespace beamid::experiments
