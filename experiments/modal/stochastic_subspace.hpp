// Modes of a structure under unmeasured random loads, with standard deviations.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/modal/poles.hpp"

namespace beamid::experiments {

struct StochasticSettings {
  Eigen::Index rows = 0;       ///< q; 0: p q of 100, less where segments were shorter than the 2 q lags
  Eigen::Index segments = 50;  ///< n_s, over which the scatter of the correlations is taken
};

struct StochasticSubspace {
  std::vector<OrderPoles> orders;
  Eigen::VectorXd singular_values;   ///< of H, falling
  Eigen::MatrixXd autocorrelations;  ///< (p x 2q) of each channel, lags dt to 2 q dt [unit^2]
};

/// Covariance-driven stochastic subspace identification [peeters1999]. With the output correlations
/// R_k = E[y(t + k) y(t)^T] in a block Hankel matrix H of q + 1 by q blocks R_(i+j-1), i, j from 1, and
/// H = U S V^T cut off at the order n, O = U_n is observability times a change of coordinates:
///
///     A = O_up^+ O_down,      C = first p rows of O,      s = log(eigenvalues of A) / dt,     shapes C phi
///
/// Standard deviations [reynders2008], [doehler2013]: the record in n_s segments gives as many H_j about
/// their mean H, hence cov(vec H) = sum_j (H_j - H)(H_j - H)^T / (n_s (n_s - 1)). Each H_j - H is carried to
/// the poles to first order, through U_n (with E = U^T (H_j - H) V, for k > n >= i)
///
///     dU_n = U_rest W,     W_ki = (s_i E_ki + s_k E_ik) / (s_i^2 - s_k^2)
///
/// and through O_up^+. They hold for segments that are long beside the decay of the modes.
/// @param outputs (p x N), one column per instant; their means are removed
/// @param largest_order orders are 2, 4, ... up to it and p q at most
/// @throws std::invalid_argument when the record is too short for rows and segments, or not finite.
StochasticSubspace stochastic_subspace(const Eigen::MatrixXd& outputs, double interval, int largest_order,
                                       const StochasticSettings& settings = {});

}  // namespace beamid::experiments
