// The separate maxima of a posterior density.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/identify/posterior/likelihood.hpp"

namespace beamid::experiments {

/// A maximum of ln L(u) - u^2 / 2 and the normal density that osculates it (Laplace).
struct Hump {
  Eigen::VectorXd top;         ///< u (q)
  double log_density = 0.0;    ///< there, of L(u) N(u; 0, 1)
  Eigen::MatrixXd covariance;  ///< (J^T J + 1)^-1 (q x q)
  double log_mass = 0.0;       ///< Laplace's: log_density + ln sqrt(det 2 pi covariance)
};

/// ln L(u) + ln N(u; 0, 1).
double posterior_log(const LikelihoodValue& value, const Eigen::VectorXd& u);

/// Where damped Newton steps from the starts (q x n) end, on all cores: those that differ, are worth at least
/// a millionth of the best by Laplace, and have a valley between them on the straight line, of half a nat at
/// least. The heaviest first.
std::vector<Hump> separate_humps(const Likelihood& likelihood, const Eigen::MatrixXd& starts);

}  // namespace beamid::experiments
