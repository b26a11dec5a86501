// How a deterministic motion misses a record, and which way to turn.
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "filters/discrete_model.hpp"
#include "filters/fisher_information.hpp"
#include "filters/measurements.hpp"

namespace beamid::filters {

/// J(c) = 1/2 sum_k |L_k^-1 (y_k - h(z_k))|^2 of the motion from z_0 = state0 + S c, over some first samples,
/// and its linearisation J(c + d) ~ 1/2 |R d - q|^2 + 1/2 remainder^2.
struct OutputErrorPass {
  bool finite = false;               ///< whether the motion, its sensitivities and J are
  std::string reason;                ///< why not
  double cost = 0.0;                 ///< J, prior included
  InformationFactor information{1};  ///< of [c, 1]: root [R q; 0 remainder] (r + 1)
  double log_likelihood = 0.0;       ///< prior excluded
  double size = 0.0;                 ///< sqrt of sum |L_k^-1 y_k|^2
  Eigen::Index measured = 0;         ///< outputs taken in
  Eigen::MatrixXd residuals;         ///< y - h (p x samples); NaN where nothing was measured
};

/// Passes through one record, of one model; settings as estimate_batch() tells.
class OutputError {
 public:
  /// @throws std::invalid_argument when shapes disagree
  OutputError(DiscreteModel& model, const Eigen::VectorXd& state0, const Eigen::MatrixXd& directions,
              const Measurements& measurements, const Eigen::MatrixXd& prior_factor);

  Eigen::VectorXd state(const Eigen::VectorXd& coefficients) const {
    return state0_ + directions_ * coefficients;
  }
  /// @throws std::invalid_argument when R of what was measured is not positive definite.
  OutputErrorPass pass(const Eigen::VectorXd& coefficients, Eigen::Index samples);

 private:
  void take_in(Eigen::Index sample, const Eigen::VectorXd& state, const Eigen::VectorXd& input,
               const Eigen::MatrixXd& moved, OutputErrorPass& result);
  void factorise_noise(Eigen::Index sample);

  DiscreteModel& model_;
  const Eigen::VectorXd& state0_;
  const Eigen::MatrixXd& directions_;
  const Measurements& measurements_;
  const Eigen::MatrixXd& prior_;
  std::vector<Eigen::Index> measured_, factorised_;  // outputs, of this sample and of noise_
  Eigen::VectorXd output_;
  Eigen::MatrixXd sensor_, rows_;
  Eigen::LLT<Eigen::MatrixXd> noise_;
};

}  // namespace beamid::filters
