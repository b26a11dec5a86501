// All samples at once: what every filter is measured against.
#pragma once

#include <string>
#include <vector>

#include "filters/discrete_model.hpp"
#include "filters/fisher_information.hpp"
#include "filters/measurements.hpp"

namespace beamid::filters {

/// Limits of the iteration, and what is known beforehand.
struct BatchSettings {
  int max_iterations = 50;  ///< passes through the record, for each of its lengths
  /// Converged when the next step is shorter than this many standard deviations of the estimate.
  double tolerance = 1e-6;
  /// U (k x r) of a prior c ~ N(0, (U^T U)^-1) about the coefficients; empty: none.
  Eigen::MatrixXd prior_factor = {};
  /// The cost of a long oscillation has a minimum for every cycle missed: from a poor guess, take up the
  /// first so many samples, then twice as many, and so on to the whole record. 0: the whole at once.
  Eigen::Index first_samples = 0;
};

/// How the iteration ended.
enum class BatchStatus {
  converged,
  undetermined,          ///< converged, but the record does not determine every coefficient
  iterations_exhausted,  ///< the last step was still longer than the tolerance
  stalled,               ///< no step, however short, lowers the cost
  failed                 ///< the motion from the initial guess cannot be followed
};

/// Maximum likelihood of z_0 = state0 + S c from y_k = h(z_k, u_k) + v_k, z_k+1 = F(z_k, u_k).
struct BatchEstimate {
  BatchStatus status = BatchStatus::failed;
  std::string reason;            ///< in words, unless converged
  Eigen::VectorXd coefficients;  ///< c (r)
  Eigen::VectorXd state;         ///< z_0, parameters included (n)
  /// Of the coefficients: inverse of the information, I^-1 (r x r); empty unless the record (with the prior)
  /// determines them all. Of the state: S I^-1 S^T.
  Eigen::MatrixXd covariance;
  InformationFactor information{1};  ///< at the estimate, prior included
  std::vector<double> costs;    ///< J of the whole record (with prior): of the guess, and after every step
  double log_likelihood = 0.0;  ///< of the outputs at the estimate, prior excluded
  Eigen::Index measured = 0;    ///< outputs taken in, M: 2 J is chi-square of M - r degrees without a prior
  Eigen::MatrixXd residuals;    ///< y - h at the estimate (p x N); NaN where nothing was measured
  int passes = 0;               ///< through the record, or part of it
};

/// Output-error maximum likelihood by Levenberg-Marquardt [marquardt1963]: the c that minimises
///
///     J(c) = 1/2 sum_k |L_k^-1 (y_k - h(z_k))|^2 + 1/2 |U c|^2,   R_k = L_k L_k^T
///
/// The motion is taken to be deterministic: the model's process noise is not used. Sensitivities
/// H_k S_k, S_k+1 = J_k S_k, come from DiscreteModel::move() and are gathered with the residuals in a
/// triangular factor [bierman1977, ch. V]: O(n r) a sample, no n x n matrix. A step is accepted only when J
/// falls. The model is left with the interval it had.
/// @param directions S: along its columns the initial state, parameters included, may change (n x r).
/// @throws std::invalid_argument when shapes disagree or R of what was measured is not positive definite.
BatchEstimate estimate_batch(DiscreteModel& model, const Eigen::VectorXd& state0,
                             const Eigen::MatrixXd& directions, const Measurements& measurements,
                             const BatchSettings& settings = {});

}  // namespace beamid::filters
