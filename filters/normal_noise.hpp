// Normal numbers in bulk.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace beamid::filters {

/// `count` standard normal numbers: those of RandomStream(seed, stream) to rounding, in a third of the time
/// where the processor has AVX2. The same on all processors of the same batch_instructions() (batch.hpp).
Eigen::VectorXd normal_noise(Eigen::Index count, std::uint64_t seed, std::uint64_t stream);

}  // namespace beamid::filters
