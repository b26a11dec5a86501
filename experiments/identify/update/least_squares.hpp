// Least squares of a residual within a box.
#pragma once

#include <optional>

#include "experiments/identify/update/fit_residual.hpp"

namespace beamid::experiments {

/// Where a search ended.
struct Fit {
  Eigen::VectorXd x;
  FitResidual::Value value;    ///< with its Jacobian
  std::vector<bool> on_bound;  ///< held there against the residual's slope
  bool converged = false;

  double chi_square() const { return value.chi_square(); }
};

/// Levenberg-Marquardt [marquardt1963] on the coordinates that are free: one on a bound that the residual
/// would push beyond it stays there. A step is at most SearchSpace::longest_step(). Points without modes
/// count as infinitely far.
/// @return nothing when there are no modes at the start.
std::optional<Fit> least_squares(const FitResidual& residual, const Eigen::VectorXd& start);

}  // namespace beamid::experiments
