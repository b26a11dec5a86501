// Groups of trials on processors with AVX2 and FMA.
#pragma once

#include "filters/algorithms/trial_group.hpp"

namespace beamid::filters::algorithms {

void run_group_avx2(TrialGroup& group);  ///< four lanes; only where compiled and the processor has both
bool compiled_for_avx2();

}  // namespace beamid::filters::algorithms
