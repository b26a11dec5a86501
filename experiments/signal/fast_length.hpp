// Lengths that transform fast: no prime factor above 7, or another that is asked for.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

bool transforms_fast(Eigen::Index length, Eigen::Index largest_factor = 7);
/// The longest of at most so many samples (1 or more).
Eigen::Index fast_length_within(Eigen::Index samples, Eigen::Index largest_factor = 7);
/// The shortest even one that holds so many samples.
Eigen::Index even_fast_length_around(Eigen::Index samples);

}  // namespace beamid::experiments
