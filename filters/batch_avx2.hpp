// Groups of trials on processors with AVX2 and FMA.
#pragma once

#include "filters/algorithms/innovation_group.hpp"
#include "filters/algorithms/trial_group.hpp"

namespace beamid::filters::algorithms {

void run_group_avx2(TrialGroup& group);  ///< four lanes; only where compiled and the processor has both
void run_innovations_avx2(InnovationGroup& group);
bool compiled_for_avx2();
/// AVX2 and FMA; no other kind of processor has them, and none counts with BEAMID_BASELINE in the
/// environment.
bool processor_has_avx2();
/// Whether it was, and the processor has both.
bool avx2_is_usable();

}  // namespace beamid::filters::algorithms
