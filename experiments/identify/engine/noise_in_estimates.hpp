// How much of a record's noise reaches each estimate: noise that is not white, and noise of the inputs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/models/identification.hpp"
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
/// Where the lines of the record bring more than that, beyond chance, they decide: sum_k u_k^2 with u_k what
/// line k of all outputs moves the unknown by, the sandwich covariance [white1982]. It holds noise that is
/// coherent between outputs or narrow, as noise of an input is.
///
/// The cost is that of a pass with all directions and of their Fourier transforms.
/// @param left readings less motion (p x N); NaN where nothing was read counts as no noise
/// @returns one for each unknown (q); ratio 1 where the record determines nothing of it
std::vector<NoiseInEstimate> noise_in_estimates(filters::DiscreteModel& model, const Eigen::VectorXd& state,
                                                const StartDirections& directions,
                                                const filters::Measurements& record,
                                                const Eigen::MatrixXd& left);

// The unknowns of a run whose inputs are noisy.

/// What becomes of the unknowns of a run where its inputs' noise counts.
struct NoisyInputFit {
  filters::Gaussian unknowns;  ///< of what the state carries for them (q)
  Eigen::VectorXd bounds;      ///< Cramer-Rao, in their units; infinite: not determined (q)
  std::string failure;         ///< why there is none; the filter's own estimate stays
  double noise_scale = 1.0;    ///< by which R of outputs whose noise is not known was multiplied
};

/// Maximum likelihood of the innovations at fixed unknowns (filters/innovation_likelihood.hpp), from where a
/// filter ended. Noise of outputs that is not known was taken from what a motion leaves of the record, which
/// holds the answer to the inputs' noise, too: it is made smaller until the mean normalised square of the
/// innovations is 1. Counted twice, 1 % of a hammer's force moved a stiffness by 10 %.
/// @param settings its noises; @param start of the whole state, the unknowns as known beforehand
/// @param noise_is_known of each output (p)
NoisyInputFit fit_noisy_inputs(const JointModel& model, const IdentificationSettings& settings,
                               const filters::Gaussian& start, const Eigen::VectorXd& found,
                               const filters::Measurements& record, const std::vector<bool>& noise_is_known);

/// Noise of inputs that nobody stated.
struct LikeliestInputNoise {
  Eigen::VectorXd deviation;     ///< of the inputs; where there are no lines, the same share of their rms (m)
  double gain = 0.0;             ///< of the logarithm of the likelihood, over that of exact inputs
  Eigen::VectorXd moved;         ///< by it, the unknowns in their deviations (q); empty: not fitted
  Eigen::VectorXd outputs = {};  ///< deviation of the outputs beside it (p); empty: levels are not known well
  double whiteness_p = 0.0;      ///< of lines of the residual whitened by them (LevelsOfNoise)
};

/// The noise of the inputs that makes the innovations likeliest at unknowns as found, and noise of the
/// outputs as large as that leaves it. Absent where the model is not linear in its motion, or its filter
/// fails.
std::optional<LikeliestInputNoise> likeliest_input_noise(const JointModel& model,
                                                         const IdentificationSettings& settings,
                                                         const filters::Gaussian& start,
                                                         const Eigen::VectorXd& found,
                                                         const filters::Measurements& record);

/// Cramer-Rao bounds by an information about what the state carries, in units of the unknowns; infinite: not
/// determined (q). @param known deviations beforehand, which bring all unknowns to one size; @param values of
/// the state (q)
Eigen::VectorXd bounds_of_unknowns(const Eigen::MatrixXd& information, const Eigen::VectorXd& known,
                                   const JointModel& model, const Eigen::VectorXd& values);

}  // namespace beamid::experiments
