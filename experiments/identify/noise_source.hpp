// Noise from where it is alone, or from what the filter makes of the whole record.
#pragma once

#include "experiments/config/experiment.hpp"
#include "experiments/models/identification.hpp"

namespace beamid::experiments {

/// Of every channel of motion, forces left out, 1.4826 times the median deviation from the median before its
/// first event, or before the first of any channel where that is earlier (find_onsets).
/// @param whole the record before any window.
/// @throws std::invalid_argument when no event is found or fewer than 32 samples lie before it.
Eigen::VectorXd noise_before_event(const Record& whole);

struct LikeliestNoise {
  Eigen::VectorXd deviation;           ///< of every output, stated ones as stated (p)
  Eigen::VectorXd relative_deviation;  ///< standard errors of it, relative; 0: stated (p)
};

/// Noise levels that maximise the filter's log-likelihood of the record, one for every quantity whose noise
/// the experiment does not state (filters/noise_estimation.hpp), from the unknowns that a run ended with.
/// @param last of that run
/// @throws std::invalid_argument when the filter cannot go through the record or every noise is stated.
LikeliestNoise likeliest_noise(const Experiment& experiment, const Record& record, const JointModel& model,
                               const IdentificationSettings& settings, const filters::Gaussian& last);

}  // namespace beamid::experiments
