// Reproducible noise: the same seed gives the same numbers on any machine and in any order.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace beamid::experiments {

/// Philox 4x32-10 [salmon2011]: four random words for a counter under a key; no state to carry along.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

/// `count` independent standard normal numbers (Box-Muller on Philox words).
/// @param seed of the study, @param stream of the case within it: different streams are independent.
Eigen::VectorXd standard_normal(Eigen::Index count, std::uint64_t seed, std::uint64_t stream);

}  // namespace beamid::experiments
