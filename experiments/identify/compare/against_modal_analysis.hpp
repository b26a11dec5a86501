// A model's lowest mode beside the modal analysis of the record.
#pragma once

#include "experiments/identify/compare/compared_run.hpp"

namespace beamid::experiments {

/// A warning where frequency or damping ratio at the estimate and in the modal analysis of the first channel
/// differ by more than three of their standard deviations together. The run is contradicted where the damping
/// ratios differ by more than a factor of two besides: such damping is not the record's. Records driven by a
/// measured force have no modal analysis, and models that are not linear no mode.
void judge_against_modal_analysis(const RunContext& context, ComparedRun& run);

}  // namespace beamid::experiments
