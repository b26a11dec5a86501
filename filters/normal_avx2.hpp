// Box-Muller on Philox words, several at a time, on processors with AVX2 and FMA.
#pragma once

#include <cstdint>

namespace beamid::filters::algorithms {

/// @param count even. Only where compiled and the processor has both.
void normal_avx2(double* numbers, std::int64_t count, std::uint64_t seed, std::uint64_t stream);
bool normal_compiled_for_avx2();

}  // namespace beamid::filters::algorithms
