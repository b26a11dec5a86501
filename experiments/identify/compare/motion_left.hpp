// Motion of a record that a model leaves, and what a filter's innovations show of it.
#pragma once

#include "experiments/identify/compare/compared_run.hpp"

namespace beamid::experiments {

/// Contradicted where the best of all starts and parameters leaves more than 10 % of a record driven by a
/// measured input, or of storeys that follow laws, and more than 50 % of a free decay.
void judge_motion_left(const RunContext& context, ComparedRun& run);

/// A warning where the innovations are not those of a consistent filter: not white, or of changing size, with
/// a probability below one in a thousand.
void judge_innovations(const RunContext& context, ComparedRun& run);

}  // namespace beamid::experiments
