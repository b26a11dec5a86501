// The half-power width of a decaying spectrum of finite length, without its bias.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

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

}  // namespace beamid::experiments
