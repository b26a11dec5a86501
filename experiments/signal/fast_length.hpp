// Lengths that transform fast: no prime factor above 7.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

bool transforms_fast(Eigen::Index length);
/// The longest of at most so many samples (1 or more).
Eigen::Index fast_length_within(Eigen::Index samples);
/// The shortest even one that holds so many samples.
Eigen::Index even_fast_length_around(Eigen::Index samples);

}  // namespace beamid::experiments
