// What the whole record says about every instant of it.
#pragma once

#include <string>
#include <vector>

#include "filters/filter_run.hpp"

namespace beamid::filters {

/// An estimate about z_k with the next state, to first or second order: deviations of z_k and of F(z_k) from
/// their means, as columns that belong together,
///
///     cov(z_k) = X X^T,   cov(F(z_k)) = Y Y^T,   cov(z_k, F(z_k)) = X Y^T
struct TransitionSpread {
  Eigen::VectorXd next;   ///< E[F(z_k)] (n)
  Eigen::MatrixXd state;  ///< X (n x m)
  Eigen::MatrixXd moved;  ///< Y (n x m)
};

/// How a smoother carries an estimate through the model.
class Smoother {
 public:
  virtual ~Smoother() = default;
  virtual TransitionSpread spread(DiscreteModel& model, const Gaussian& filtered,
                                  const Eigen::VectorXd& input) = 0;
};

using SmootherRegistry = Registry<Smoother>;
SmootherRegistry& smoother_registry();

enum class Smooth { states, states_and_noises };

/// z_k | y_0 ... y_N-1 for every sample k.
struct SmoothedRun {
  std::vector<Gaussian> estimates;  ///< (N)
  /// w_k | y_0 ... y_N-1, the process noise on the way from sample k to k + 1 (N - 1); empty unless asked
  /// for.
  std::vector<Gaussian> noises;
};

/// Rauch-Tung-Striebel recursion [rauch1965] backwards over the filtered estimates:
///
///     G = X Y^T (Y Y^T + Q)^-1,   m_s = m + G (m_s+ - E F(z)),   P_s = P - G (Y Y^T + Q) G^T + G P_s+ G^T
///
/// The inverse is never formed: with B = [Y, Q^1/2], G = [X, 0] B^+, and P_s is the sum of the squares of
/// [X, 0] (I - B^+ B) and G P_s+^1/2. That is positive by construction, and right where Y Y^T + Q is singular
/// (a parameter known exactly, no process noise).
///
/// Where the run ended early, what was reached is smoothed. A state of thousands of entries whose estimates
/// are factors gets factors; without process noise their rank does not grow.
/// @param model as the filter saw it, process noise included; it is left with the interval it had.
/// @param method registered smoother: "rts", "urts"
/// @throws std::invalid_argument when the run kept no estimates or is not of this record; FilterFailure when
/// a covariance is not positive.
SmoothedRun smooth(const FilterRun& run, DiscreteModel& model, const Measurements& measurements,
                   const std::string& method = "rts", const Options& options = {},
                   Smooth what = Smooth::states);

/// z_k | y_0 ... y_k+lag for every sample k of a run: each what smooth() gives for the record up to k + lag,
/// at a cost of `lag` steps backwards per sample.
/// @throws std::invalid_argument as smooth() does, and when lag < 0.
std::vector<Gaussian> fixed_lag_smooth(const FilterRun& run, DiscreteModel& model,
                                       const Measurements& measurements, Eigen::Index lag,
                                       const std::string& method = "rts", const Options& options = {});

}  // namespace beamid::filters
