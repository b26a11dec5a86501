// Parameters by the likelihood of a Kalman filter's innovations.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "filters/discrete_model.hpp"
#include "filters/measurements.hpp"

namespace beamid::filters {

/// A model whose motion is linear where some entries theta of its state are held, and a record of it. With
/// theta held, the Kalman filter is exact, and so is the likelihood of its innovations e_k ~ N(0, S_k):
///
///     J(theta) = 1/2 sum_k (e_k^T S_k^-1 e_k + ln det S_k) + 1/2 |theta - theta_0|^2_(P_0^-1)
///
/// An extended filter of motion and theta together is not: under process noise it linearises about motions
/// that are themselves uncertain, and comes out biased [ljung1979]. The information
///
///     I_ij = sum_k d_i e_k^T S_k^-1 d_j e_k + 1/2 tr(S_k^-1 d_i S_k S_k^-1 d_j S_k)
///
/// is that of the record about theta, its inverse the Cramer-Rao bound.
struct InnovationProblem {
  DiscreteModel& model;
  const Measurements& record;           ///< at even stamps, every output read
  std::vector<Eigen::Index> constants;  ///< places of theta in the state (q)
  Gaussian start;                       ///< of the whole state; of theta: theta_0, P_0 (its covariance)
};

struct InnovationFit {
  Eigen::VectorXd constants;    ///< theta (q)
  Eigen::MatrixXd information;  ///< I, without P_0 (q x q)
  double cost = 0.0;            ///< J
  bool converged = false;
};

/// Gauss-Newton from `begin` (q), its derivatives central differences of steps of a thousandth of the
/// deviations; halved where J would grow. Converged: the last step was below 2 % of the deviations.
/// @throws std::invalid_argument where the problem's record has gaps or uneven stamps;
/// std::runtime_error where a covariance is not positive.
InnovationFit fit_innovations(const InnovationProblem& problem, const Eigen::VectorXd& begin);

/// I at theta (q x q).
Eigen::MatrixXd innovation_information(const InnovationProblem& problem, const Eigen::VectorXd& constants);

}  // namespace beamid::filters
