// The classical check of a damping ratio: how fast successive peaks shrink.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

// The half-power width of a decaying spectrum of finite length, without its bias.

/// |S|^2 of z_m = e^(-D m h), m = 0 .. M-1, at a distance from its peak [rad/s], over that at the peak:
///
///     S = (1 - q^M) / (1 - q),    q = e^(-(D + i distance) h)
double relative_power(double damping_rate, double distance, Eigen::Index count, double interval);

/// Where it is a half [rad/s]; D for an endless record, more for a shorter one.
double half_power_distance(double damping_rate, Eigen::Index count, double interval);

/// The damping rate whose spectrum over M values has that half-power distance [1/s]; 0 where not even an
/// undamped one is as narrow.
double damping_rate_of_distance(double distance, Eigen::Index count, double interval);

/// Half-power points of a signal's spectrum, at w from `lower` to `upper` [rad/s].
struct HalfPowerPoints {
  double lower = 0, upper = 0;
  double centre() const { return 0.5 * (lower + upper); }
  double distance() const { return 0.5 * (upper - lower); }
  /// (M) what centre and distance change by with each value: d centre = Re sum_m c_m dz_m.
  Eigen::VectorXcd centre_slope, distance_slope;
};

/// Of the transform sum_m z_m e^(-i w m h), at any w between its lines, about the peak nearest to 0.
/// @param scale about the half-power distance to be expected [rad/s]
/// @throws std::invalid_argument when the spectrum does not fall to a half on either side.
HalfPowerPoints half_power_points(const Eigen::VectorXcd& values, double interval, double scale);

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
