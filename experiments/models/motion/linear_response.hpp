// Frequency response of linear motion at fixed unknowns.
#pragma once

#include <Eigen/Core>

#include "filters/continuous_model.hpp"

namespace beamid::experiments {

/// x' = A x + B u, y = C x + D u of a LinearMotion at one state's unknowns, A = V diag(lambda) V^-1:
///
///     G(omega) = C (i omega - A)^-1 B + D = sum_k c_k b_k^T / (i omega - lambda_k) + D,   omega > 0
///
/// with c_k = C v_k and b_k^T = row k of V^-1 B.
class LinearResponse {
 public:
  /// @param state unknowns in their places (n); its motion is not read
  /// @throws std::runtime_error where A is not finite or has no independent eigenvectors (a rigid motion, a
  /// critically damped mode).
  LinearResponse(const filters::LinearMotion& motion, const Eigen::VectorXd& state);

  Eigen::Index motion_size() const { return poles_.size(); }  ///< l

  /// G(omega) (p x m), and what is added to G u at this line by motion that does not repeat itself after the
  /// record, for a unit of each coordinate of d = x_0 - x_N (p x l): C (1 - e^((A - i omega) dt))^-1.
  /// @param interval dt [s]
  void line(double omega, double interval, Eigen::MatrixXcd& transfer, Eigen::MatrixXcd& free) const;

  const Eigen::VectorXcd& poles() const { return poles_; }  ///< lambda (l) [1/s]

 private:
  Eigen::VectorXcd poles_;
  Eigen::MatrixXcd sensors_, inputs_, inverse_;  // C V (p x l), V^-1 B (l x m), V^-1 (l x l)
  Eigen::MatrixXd direct_;                       // D (p x m)
};

}  // namespace beamid::experiments
