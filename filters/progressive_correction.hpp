// A likelihood worked in by powers of itself [musso2001].
#pragma once

#include <Eigen/Core>

namespace beamid::filters {

/// Weights w_i exp(-share c_i / 2), scaled to sum to one, and the logarithm of their sum before.
struct Reweighted {
  Eigen::VectorXd weights;
  double log_sum = 0.0;
};

/// @param squares c_i = -2 log of the likelihood of each of N samples, without its constant (N).
Reweighted reweighted(const Eigen::VectorXd& weights, const Eigen::VectorXd& squares, double share);

/// The largest share of the likelihood, up to `left`, after which the effective sample size 1 / sum w_i^2 is
/// still `enough`; to 1 %.
double affordable_share(const Eigen::VectorXd& weights, const Eigen::VectorXd& squares, double left,
                        double enough);

}  // namespace beamid::filters
