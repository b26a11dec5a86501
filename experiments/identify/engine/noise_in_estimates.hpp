// How much of a record's noise reaches each estimate, where the noise is not white.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/models/joint_model.hpp"
#include "filters/discrete_model.hpp"
#include "filters/measurements.hpp"

namespace beamid::experiments {

/// Of one unknown.
struct NoiseInEstimate {
  double ratio = 1;      ///< deviation of the estimate in the record's noise over that in white noise R
  double freedom = 1e9;  ///< degrees of freedom that the square of it is known with
};

/// Least squares with R = diag(r_i) on the motion from `state` find each unknown j with an error that is
/// linear in the noise e, by the influence g_j = rows of (S^T R^-1 S)^-1 S^T R^-1 (S: sensitivities of all
/// samples to the start and the unknowns). In noise of density G_i(f) per output, white noise being r_i,
///
///     var_j / var_j(white) = sum_ik |g_ji(f_k)|^2 G_i(f_k) / sum_ik |g_ji(f_k)|^2 r_i
///
/// so that what counts is the density where the unknown is determined: at the modes, each by its share. G is
/// what the motion leaves of the record, its periodogram averaged over lines from f / 1.6 to 1.6 f, over the
/// share of each line that the fit does not take, 1 - sum_c |Q_ic(f_k)|^2, Q an orthonormal basis of R^-1/2
/// S.
///
/// The cost is that of a pass with all directions and of their Fourier transforms.
/// @param left readings less motion (p x N); NaN where nothing was read counts as no noise
/// @returns one for each unknown (q); ratio 1 where the record determines nothing of it
std::vector<NoiseInEstimate> noise_in_estimates(filters::DiscreteModel& model, const Eigen::VectorXd& state,
                                                const StartDirections& directions,
                                                const filters::Measurements& record,
                                                const Eigen::MatrixXd& left);

}  // namespace beamid::experiments
