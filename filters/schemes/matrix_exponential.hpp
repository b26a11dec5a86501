// e^A of small matrices, with its directional derivatives.
#pragma once

#include <Eigen/Core>

namespace beamid::filters {

/// e^A of a 2 x 2 matrix in closed form, and its derivative in any direction.
///
/// With s = tr A / 2 and q = s^2 - det A:  e^A = e^s (c(q) I + S(q) (A - s I)),  c = cosh sqrt q,
/// S = sinh(sqrt q) / sqrt q. Both are entire functions of q, so light, critical and heavy damping are one
/// case.
class Exponential2x2 {
 public:
  explicit Exponential2x2(const Eigen::Matrix2d& a);

  const Eigen::Matrix2d& value() const { return value_; }
  /// d/dt e^(A + t direction) at t = 0.
  Eigen::Matrix2d derivative(const Eigen::Matrix2d& direction) const;

 private:
  Eigen::Matrix2d deviator_;  // A - s I
  double growth_;             // e^s
  double c_, s_, s_slope_;    // c(q), S(q), dS/dq
  Eigen::Matrix2d value_;
};

/// e^A (n x n) and d/dt e^(A + t direction): the blocks of exp [A direction; 0 A] [higham2008, eq. 3.16].
void exponential_with_derivative(const Eigen::MatrixXd& a, const Eigen::MatrixXd& direction,
                                 Eigen::MatrixXd& value, Eigen::MatrixXd& derivative);

}  // namespace beamid::filters
