// A pole that a modal analysis found at one model order.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <limits>
#include <vector>

namespace beamid::experiments {

/// y(t) = Re(shape e^(rate t)) in a free decay. Deviations are NaN where the method knows none.
struct Pole {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::complex<double> rate;  ///< s = w (-damping ratio + i sqrt(1 - damping ratio^2)) [rad/s], Im s > 0
  Eigen::VectorXcd shape;     ///< (p) of any scale
  double frequency_deviation_hz = unknown;
  double damping_ratio_deviation = unknown;
  Eigen::VectorXd shape_deviation = {};  ///< (p) of |shape| scaled to 1 at its largest; empty: unknown

  double frequency_hz() const;   ///< undamped, |s| / (2 pi)
  double damping_ratio() const;  ///< -Re s / |s|

  /// Standard deviations of both, from the covariance (2 x 2) of Im s and -Re s [rad^2/s^2].
  void take_deviations(const Eigen::Matrix2d& covariance);
};

/// The oscillating poles of one model order, by rising frequency.
struct OrderPoles {
  int order = 0;
  std::vector<Pole> poles;
};

/// Modal assurance criterion |a^H b|^2 / (|a|^2 |b|^2) of two shapes (p) [allemang2003]; 1 for p = 1.
double modal_assurance(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b);

/// Modal phase collinearity of a shape (p) [pappa1993]: 1 when all channels move in phase or in opposition,
/// 0 when their phases are anything. With S the 2 x 2 matrix of products of real and imaginary parts, it is
/// ((Sxx - Syy)^2 + 4 Sxy^2) / (Sxx + Syy)^2.
double phase_collinearity(const Eigen::VectorXcd& shape);

}  // namespace beamid::experiments
