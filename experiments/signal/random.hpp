// Reproducible noise: the same seed gives the same numbers on any machine and in any order.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "filters/random.hpp"

namespace beamid::experiments {

/// `count` independent standard normal numbers.
/// @param seed of the study, @param stream of the case within it: different streams are independent.
inline Eigen::VectorXd standard_normal(Eigen::Index count, std::uint64_t seed, std::uint64_t stream) {
  return filters::RandomStream(seed, stream).normal(count, 1);
}

}  // namespace beamid::experiments
