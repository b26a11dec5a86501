// Motion of a record that a model leaves, and what a filter's innovations show of it.
#pragma once

#include "experiments/identify/compare/compared_run.hpp"

namespace beamid::experiments {

/// Contradicted where the best of all starts and parameters leaves more than 10 % of a record driven by a
/// measured input, or of storeys that follow laws, and more than 50 % of a free decay; approximate where
/// is_approximate().
void judge_motion_left(const RunContext& context, ComparedRun& run);

/// Whether the model explains at least 70 % of a driven record that sections were made of, and more than 10 %
/// of it is left and no noise.
bool is_approximate(const ComparedRun& run);

/// Contradicted where one described quantity, changed alone, explains half of what is left or more, or where
/// one surely differs, by five of its deviations, and moves an unknown by more than the interval reported.
/// @returns whether a cause was named
bool judge_faults(ComparedRun& run);

/// A warning where the innovations are not those of a consistent filter: not white, or of changing size, with
/// a probability below one in a thousand.
void judge_innovations(const RunContext& context, ComparedRun& run);

}  // namespace beamid::experiments
