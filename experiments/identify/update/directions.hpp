// What the residual's derivative determines, direction by direction.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/identify/update/updating.hpp"

namespace beamid::experiments {

/// Singular directions v_i of the residual's derivative J = dr/dx (r x q), of standard deviation 1 / s_i.
/// Those below open_deviation are determined, the others open.
struct Directions {
  Eigen::MatrixXd covariance;                 ///< (q x q) sum of v v^T / s^2 over all that change anything
  Eigen::VectorXd open_share, open_variance;  ///< (q) of the open ones, in each parameter
  std::vector<OpenDirection> open;
  Eigen::Index determined = 0;  ///< how many are
};

/// @param columns of J that may change; what is held has no part
Directions directions_of(const Eigen::MatrixXd& derivative, const std::vector<Eigen::Index>& columns);

}  // namespace beamid::experiments
