// Parameters by the likelihood of a Kalman filter's innovations.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "filters/linear_gaussian.hpp"

namespace beamid::filters {

// Many linear models on one record, by the vector engine.

/// What the Kalman filter of one model says of a record: innovations e_k and their covariances S_k.
struct InnovationPass {
  Eigen::MatrixXd innovations;        ///< (p x N); NaN where an output was not read
  Eigen::MatrixXd covariances;        ///< S of every step, of the outputs read (p p x steps at least)
  std::vector<std::int64_t> step_of;  ///< (N)
  double squares = 0.0;               ///< sum_k e_k^T S_k^-1 e_k
  double log_determinants = 0.0;      ///< sum_k ln det S_k
  bool failed = false;                ///< some S_k is not positive, or the likelihood is not finite

  double cost() const { return 0.5 * (squares + log_determinants); }  ///< -ln L but for a constant
  auto covariance(Eigen::Index k) const {                             ///< S_k (p x p)
    const Eigen::Index p = innovations.rows();
    return Eigen::Map<const Eigen::MatrixXd>(covariances.col(step_of[static_cast<std::size_t>(k)]).data(), p,
                                             p);
  }
};

/// As kalman_pass(), of several models of one shape, four side by side where the processor has AVX2, else
/// two.
/// @param covariances whether they are asked for; without, they are empty
/// @throws std::invalid_argument where stamps are uneven
std::vector<InnovationPass> innovation_passes(const std::vector<LinearGaussian>& models,
                                              const Measurements& record, double interval, bool covariances);

/// Linear models, one for each theta, and a record of one of them. The likelihood of the Kalman filter's
/// innovations e_k ~ N(0, S_k) is exact:
///
///     J(theta) = 1/2 sum_k (e_k^T S_k^-1 e_k + ln det S_k) + 1/2 |theta - theta_0|^2_(P_0^-1)
///
/// That of an extended filter of motion and theta together is not: under process noise it linearises about
/// motions that are themselves uncertain, and comes out biased [ljung1979]. The information
///
///     I_ij = sum_k d_i e_k^T S_k^-1 d_j e_k + 1/2 tr(S_k^-1 d_i S_k S_k^-1 d_j S_k)
///
/// is that of the record about theta, its inverse the Cramer-Rao bound. theta may be any constants: of the
/// motion, of its noise, of that of the sensors.
struct InnovationProblem {
  std::function<LinearGaussian(const Eigen::VectorXd& theta)> model;
  const Measurements& record;  ///< at even stamps
  double interval = 0.0;       ///< [s]
  Gaussian prior;              ///< theta_0, P_0 (its covariance) (q)
  /// Whether inputs that are not exact are of no law at all: S_k then holds what is not known of them, and
  /// how theta passes it on. ln det S_k would pull theta to where this is little; without it, and without the
  /// trace in I, E[d J] is 0 at the truth for whatever the inputs were (errors in variables).
  bool free_inputs = false;
};

/// A model whose motion is linear where some entries of its state are held: theta are those entries.
/// @param model outlives the problem; @param start of the whole state; of theta: theta_0, P_0
InnovationProblem held_problem(DiscreteModel& model, const Measurements& record,
                               const std::vector<Eigen::Index>& held, const Gaussian& start);

/// ln p(record | theta) but for a constant, its gradient, and I; without the prior.
struct InnovationSlope {
  double log_likelihood = 0.0;
  Eigen::VectorXd gradient;     ///< (q)
  Eigen::MatrixXd information;  ///< I (q x q)
};

/// @throws std::runtime_error where a covariance is not positive.
double innovation_log_likelihood(const InnovationProblem& problem, const Eigen::VectorXd& theta);
/// Derivatives are central differences of steps of a thousandth of the deviations known beforehand.
InnovationSlope innovation_slope(const InnovationProblem& problem, const Eigen::VectorXd& theta);

struct InnovationFit {
  Eigen::VectorXd constants;    ///< theta (q)
  Eigen::MatrixXd information;  ///< I, without P_0 (q x q)
  double cost = 0.0;            ///< J
  bool converged = false;
};

/// Where a search may end.
struct InnovationSearch {
  int most_iterations = 100;  ///< a logarithm of a noise falls by 0.5 at most in each
  /// A maximum found before: a search that comes within a deviation of it ends there, not converged.
  const InnovationFit* known = nullptr;
};

/// Gauss-Newton from `begin` (q), its derivatives central differences of steps of a thousandth of the
/// deviations known beforehand; halved where J would grow or there is no model, then damped. Converged: the
/// last step was below 2 % of the deviations, or no step below 10 % of them lowers J, for rounding.
/// @throws std::invalid_argument where stamps are uneven; std::runtime_error where a covariance is not
/// positive at `begin`.
InnovationFit fit_innovations(const InnovationProblem& problem, const Eigen::VectorXd& begin,
                              const InnovationSearch& search = {});

/// I at theta (q x q).
Eigen::MatrixXd innovation_information(const InnovationProblem& problem, const Eigen::VectorXd& constants);

}  // namespace beamid::filters
