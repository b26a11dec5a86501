// How the scatter of a Hankel matrix becomes that of poles and shapes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/modal/pole.hpp"

namespace beamid::experiments {

/// H = U S V^T (a x b, a >= b) in full, and how it scatters.
struct ScatteredHankel {
  Eigen::MatrixXd left;             ///< U (a x a)
  Eigen::VectorXd singular_values;  ///< (a), the last a - b of them zero
  /// E_j = U^T dH_j V, padded by zeros to (a x a); cov(vec H) = sum_j vec(dH_j) vec(dH_j)^T.
  std::vector<Eigen::MatrixXd> changes;
  Eigen::Index outputs = 1;  ///< p rows to a block
};

/// Poles of order n and their standard deviations by first-order propagation (stochastic_subspace.hpp).
std::vector<Pole> scattered_poles(const ScatteredHankel& hankel, int order, double interval);

}  // namespace beamid::experiments
