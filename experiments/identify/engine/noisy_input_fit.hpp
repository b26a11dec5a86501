// The unknowns of a run whose inputs are noisy.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/models/identification.hpp"
#include "experiments/models/joint_model.hpp"

namespace beamid::experiments {

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
  Eigen::VectorXd deviation;  ///< of the inputs, all the same share of their rms (m)
  double gain = 0.0;          ///< of the logarithm of the likelihood, over that of exact inputs
  Eigen::VectorXd moved;      ///< by it, the unknowns in their deviations (q); empty: not fitted
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
