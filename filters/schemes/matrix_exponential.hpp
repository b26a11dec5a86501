// e^A of small matrices, with its directional derivatives.
#pragma once

#include <Eigen/Core>

#include "filters/algorithms/entire_functions.hpp"

namespace beamid::filters {

/// e^A of a 2 x 2 matrix in closed form, and its derivative in any direction.
///
/// With s = tr A / 2, D = A - s I and z = s^2 - det A = -det D:  e^A = e^s (c(z) I + s(z) D), c = cosh sqrt
/// z, s(z) = sinh(sqrt z) / sqrt z. Both are entire functions of z (algorithms/entire_functions.hpp), so
/// light, critical and heavy damping are one case.
class Exponential2x2 {
 public:
  explicit Exponential2x2(const Eigen::Matrix2d& a);

  const Eigen::Matrix2d& value() const { return value_; }
  /// d/dt e^(A + t direction) at t = 0.
  Eigen::Matrix2d derivative(const Eigen::Matrix2d& direction) const;

 private:
  Eigen::Matrix2d deviator_;  // D
  double c_, s_, s_slope_;    // e^s times c(z), s(z), ds/dz
  Eigen::Matrix2d value_;
};

inline Exponential2x2::Exponential2x2(const Eigen::Matrix2d& a) {
  const double half_trace = 0.5 * a.trace();
  deviator_ = a - half_trace * Eigen::Matrix2d::Identity();
  const double z = -deviator_.determinant();  // = s^2 - det A, without the cancellation
  const auto [c, s, slope] = algorithms::damped_entire_functions<double>(z, -half_trace);
  c_ = c, s_ = s, s_slope_ = slope;
  value_ = c_ * Eigen::Matrix2d::Identity() + s_ * deviator_;
}

inline Eigen::Matrix2d Exponential2x2::derivative(const Eigen::Matrix2d& direction) const {
  const double half_trace = 0.5 * direction.trace();
  const Eigen::Matrix2d deviator = direction - half_trace * Eigen::Matrix2d::Identity();
  const double z_slope = deviator_.transpose().cwiseProduct(deviator).sum();  // z = tr(D^2) / 2, dc/dz = s/2
  return half_trace * value_ + (0.5 * s_ * z_slope) * Eigen::Matrix2d::Identity() +
         (s_slope_ * z_slope) * deviator_ + s_ * deviator;
}

/// e^A (n x n) and d/dt e^(A + t direction): the blocks of exp [A direction; 0 A] [higham2008, eq. 3.16].
void exponential_with_derivative(const Eigen::MatrixXd& a, const Eigen::MatrixXd& direction,
                                 Eigen::MatrixXd& value, Eigen::MatrixXd& derivative);

}  // namespace beamid::filters
