#include "filters/schemes/matrix_exponential.hpp"

#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

namespace beamid::filters {

Exponential2x2::Exponential2x2(const Eigen::Matrix2d& a) {
  const double half_trace = 0.5 * a.trace();
  deviator_ = a - half_trace * Eigen::Matrix2d::Identity();
  growth_ = std::exp(half_trace);
  const double q = -deviator_.determinant();  // = s^2 - det A, without the cancellation
  if (std::abs(q) < 1e-2) {
    // sum q^k/(2k)!, sum q^k/(2k+1)! and sum k q^(k-1)/(2k+1)!; the first term left out is below 1e-17
    c_ = 1.0 + q / 2.0 * (1.0 + q / 12.0 * (1.0 + q / 30.0 * (1.0 + q / 56.0 * (1.0 + q / 90.0))));
    s_ = 1.0 + q / 6.0 * (1.0 + q / 20.0 * (1.0 + q / 42.0 * (1.0 + q / 72.0 * (1.0 + q / 110.0))));
    s_slope_ = 1.0 / 6.0 + q * (1.0 / 60.0 + q * (1.0 / 1680.0 + q * (1.0 / 90720.0 + q / 7983360.0)));
  } else {
    const double root = std::sqrt(std::abs(q));
    c_ = q > 0.0 ? std::cosh(root) : std::cos(root);
    s_ = (q > 0.0 ? std::sinh(root) : std::sin(root)) / root;
    s_slope_ = (c_ - s_) / (2.0 * q);
  }
  value_ = growth_ * (c_ * Eigen::Matrix2d::Identity() + s_ * deviator_);
}

Eigen::Matrix2d Exponential2x2::derivative(const Eigen::Matrix2d& direction) const {
  const double half_trace = 0.5 * direction.trace();
  const Eigen::Matrix2d deviator = direction - half_trace * Eigen::Matrix2d::Identity();
  // q = tr(deviator_^2) / 2, dc/dq = S/2
  const double q_slope = (deviator_ * deviator).trace();
  return half_trace * value_ + growth_ * (0.5 * s_ * q_slope * Eigen::Matrix2d::Identity() +
                                          s_slope_ * q_slope * deviator_ + s_ * deviator);
}

void exponential_with_derivative(const Eigen::MatrixXd& a, const Eigen::MatrixXd& direction,
                                 Eigen::MatrixXd& value, Eigen::MatrixXd& derivative) {
  const Eigen::Index n = a.rows();
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  block.topLeftCorner(n, n) = block.bottomRightCorner(n, n) = a;
  block.topRightCorner(n, n) = direction;
  const Eigen::MatrixXd exponential = block.exp();
  value = exponential.topLeftCorner(n, n);
  derivative = exponential.topRightCorner(n, n);
}

}  // namespace beamid::filters
