// A part whose noise is larger than stated.
#pragma once

#include "experiments/identify/compare/comparison.hpp"

namespace beamid::experiments {

/// Widens the deviations of a run by sqrt(mean of innovation^T S^-1 innovation / p) where that is beyond what
/// chance allows above 1, unless they are widened as much already, and says so first among its warnings. With
/// all noise s times what was stated, that of the estimates is s times theirs: the weights stay the same.
void widen_by_innovations(ComparedRun& run);

}  // namespace beamid::experiments
