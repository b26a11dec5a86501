// The square root of a covariance as measurements turn it.
#pragma once

#include <Eigen/Core>

namespace beamid::filters {

/// T (r x r) upper triangular, T T^T the covariance of r coefficients, the identity at first.
///
/// An output of noise d that sees them as z^T = y^T T turns it into T M, M upper triangular [carlson1973]:
///
///     M M^T = I - z z^T / (d + z^T z),   b_j = d + z_1^2 + ... + z_j^2
///     M_jj = sqrt(b_j-1 / b_j),   M_ij = -z_i z_j / sqrt(b_j-1 b_j)
///
/// The diagonal is a product of ratios below one: the covariance cannot lose its positivity.
class TriangularRoot {
 public:
  void restart(Eigen::Index size);  ///< T = I
  const Eigen::MatrixXd& matrix() const { return root_; }

  /// @param seen how outputs of independent noises see the coefficients, a row y^T each (p x r).
  /// @param variances d of each (p); zero: without noise.
  void take_in(const Eigen::MatrixXd& seen, const Eigen::VectorXd& variances);

  /// Asked after every `interval` calls of take_in(): whether what the outputs saw of a column of T was a
  /// small difference of larger numbers, or T is about to leave the range of numbers. Over an interval, since
  /// an output may pass through zero.
  bool cancels();
  static constexpr Eigen::Index interval = 64;

 private:
  void take_in(const Eigen::MatrixXd& seen, Eigen::Index output, double variance);

  Eigen::MatrixXd root_;
  Eigen::VectorXd partial_, terms_, sums_;  // sum z_j T_j; squares of sum |y_i T_ij| and of z_j (r)
};

}  // namespace beamid::filters
