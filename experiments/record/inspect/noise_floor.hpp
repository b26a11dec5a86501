// How much of a signal is noise, and in which steps its values are written.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

/// Standard deviation of a signal's broadband noise, taken as white.
///
/// In windows of 512 samples, each without its line and under a Hann window, the median of the periodogram
/// between a quarter and three quarters of half the sampling rate, over ln 2, is the density of white noise:
/// a few modes do not move it, the anti-alias filter lies above, the drift below. Of the windows the quietest
/// quarter counts, as hits are broadband too.
/// @param signal (N), at least 64 samples, finite.
/// @throws std::invalid_argument when the signal is shorter.
double noise_floor(const Eigen::VectorXd& signal);

}  // namespace beamid::experiments
