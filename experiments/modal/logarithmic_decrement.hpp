// The classical check of a damping ratio: how fast successive peaks shrink.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

struct DecrementSettings {
  double smallest_swing =
      0.1;  ///< swings below this part of the largest one are left out, as is what follows
};

struct DecrementEstimate {
  double frequency_hz = 0;                     ///< undamped
  double frequency_standard_deviation_hz = 0;  ///< from the scatter of the peaks' times about the line
  double damping_ratio = 0;
  double damping_ratio_standard_deviation = 0;  ///< from the scatter of the swings about the line
  double decrement = 0;  ///< per cycle, the natural logarithm of the ratio of successive peaks
  int peaks = 0;         ///< maxima and minima used
};

/// Logarithmic decrement of a free decay (N) of one mode. Peaks p_k, maxima and minima in turn, are the
/// vertices of parabolas fitted around them; the swings |p_k - p_(k+1)|, in which a constant offset cancels,
/// obey
///
///     log |p_k - p_(k+1)| = const - k decrement / 2,     damping ratio = decrement / sqrt(4 pi^2 +
///     decrement^2)
///
/// by linear regression on k, and the times of the peaks give half the damped period [rao2018, sec. 2.6].
/// @throws std::invalid_argument when fewer than 4 peaks are found.
DecrementEstimate logarithmic_decrement(const Eigen::VectorXd& signal, double interval,
                                        const DecrementSettings& settings = {});

}  // namespace beamid::experiments
