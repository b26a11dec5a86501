// Modal coordinates carried over an interval, exactly.
#pragma once

#include <Eigen/Core>

#include "fem/response/modal_basis.hpp"

namespace beamid::fem {

/// x(t + h) = A x(t) + V f(t) + U f(t + h) for the state x = (z, z') (2k) and inputs f linear in between:
/// mode by mode (oscillator_step.hpp) or, where dashpots couple the modes, by the exponential of the matrix
/// of all of them, inputs included [vanloan1978]. A - I is what is kept: a slow motion is not rounded to its
/// own size at every step.
class ModalTransition {
 public:
  /// @param loads Gamma (k x m) of the inputs, @param interval h [s]
  ModalTransition(const ModalBasis& basis, const Eigen::MatrixXd& loads, double interval);

  /// A x, column by column (2k x any).
  Eigen::MatrixXd apply(const Eigen::MatrixXd& states) const;

  /// Rows times A (any x 2k).
  Eigen::MatrixXd apply_to_rows(const Eigen::MatrixXd& rows) const;

  Eigen::MatrixXd from, to;  ///< V, U (2k x m)

 private:
  bool coupled_;
  Eigen::MatrixXd increment_;         ///< A - I (2k x 2k), when coupled
  Eigen::ArrayXd zz_, zv_, vz_, vv_;  ///< else its four diagonals (k)
};

}  // namespace beamid::fem
