// What the sensors inside a part show, frequency by frequency.
#pragma once

#include <complex>

#include <Eigen/Core>

#include "experiments/models/motion/second_order_motion.hpp"
#include "filters/continuous_model.hpp"

namespace beamid::experiments {

// Frequency response of linear motion at fixed unknowns.

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

  /// G u of every line, and what is added to it by motion that does not repeat itself after the record,
  ///
  ///     y_k = G(omega_k) u_k + C (1 - e^((A - i omega_k) dt))^-1 d,    d = x_0 - x_N
  ///
  /// @param omega [rad/s] (L); @param interval dt [s]; @param inputs u (m x L); @param difference d (l)
  /// @returns (p x L)
  Eigen::MatrixXcd motion(const Eigen::VectorXd& omega, double interval, const Eigen::MatrixXcd& inputs,
                          const Eigen::VectorXd& difference) const;

  /// What d adds to the lines: columns that span it, a real one for a real pole, two for a conjugate pair
  /// (p L x l), all channels of one line, then those of the next.
  Eigen::MatrixXcd free_motions(const Eigen::VectorXd& omega, double interval) const;

  /// d from its coefficients in those columns (l).
  Eigen::VectorXd difference(const Eigen::VectorXd& coefficients) const;

  const Eigen::VectorXcd& poles() const { return poles_; }  ///< lambda (l) [1/s]

 private:
  Eigen::VectorXcd poles_;
  Eigen::MatrixXcd shapes_, sensors_, inputs_, inverse_;  // V, C V (p x l), V^-1 B (l x m), V^-1 (l x l)
  Eigen::MatrixXd direct_;                                // D (p x m)
};

/// A part between supports (supported_motion.hpp) at fixed unknowns, x inside, s its supports:
///
///     x'' + D_xx x' + W_xx x = B_x u - D_xs s' - W_xs s,    s'' = B_s u,    a = h x'' + h_s s''
///
/// in the eigenvectors of W_xx, where D_xx is diagonal unless dashpots couple them. Nothing is cut off: those
/// far above the frequencies of a record follow statically by themselves.
class SupportedResponse {
 public:
  /// @param form its W, D and B; @param rows what the sensors of acceleration read (p x n), supports last
  /// @param supports b
  /// @throws std::runtime_error where W_xx has no real eigenvalues, or one that is not positive.
  SupportedResponse(const SecondOrderForm& form, const Eigen::MatrixXd& rows, Eigen::Index supports);

  /// omega of its modes with the supports at rest, undamped, ascending [rad/s] (n - b).
  const Eigen::VectorXd& frequencies() const { return frequencies_; }

  /// a = G(omega) u of motion e^(i omega t) (p x m), omega > 0.
  Eigen::MatrixXcd transfer(double omega) const;

  /// Motion with u = 0: real and imaginary parts of h_j e^(lambda_j t).
  struct FreeMotion {
    Eigen::VectorXcd poles;   ///< lambda (k), none with a negative imaginary part [1/s]
    Eigen::MatrixXcd shapes;  ///< h (p x k)
  };
  /// That of its lowest modes. @param count of them
  FreeMotion free_motion(Eigen::Index count) const;

 private:
  Eigen::VectorXd frequencies_, stiffness_, damping_;  // stiffness_: omega^2
  Eigen::MatrixXd coupled_;                            // of D_xx; empty where it is diagonal
  Eigen::MatrixXd rows_, rows_of_supports_;            // (p x n - b), (p x m)
  Eigen::MatrixXd pushed_, held_, dragged_;            // by u, s and s' of a unit s'' (n - b x m)
};

}  // namespace beamid::experiments
