// Noise from where it is alone, or from what the filter makes of the whole record.
#pragma once

#include <Eigen/Core>

#include "experiments/identify/record_identification.hpp"

namespace beamid::experiments {

/// Of every channel of motion, forces left out, 1.4826 times the median deviation from the median before its
/// first event, or before the first of any channel where that is earlier (find_onsets).
/// @param whole the record before any window.
/// @throws std::invalid_argument when no event is found or fewer than 32 samples lie before it.
Eigen::VectorXd noise_before_event(const Record& whole);

/// Noise levels that maximise the filter's log-likelihood of the record, one for every quantity whose noise
/// the experiment does not state (filters/noise_estimation.hpp), from the parameters that `found` has. Sets
/// the noise in `found` and the standard errors of it; all else remains.
/// @throws std::invalid_argument when the filter cannot go through the record or every noise is stated.
void take_likeliest_noise(const Experiment& experiment, const Record& record, RecordIdentification& found);

}  // namespace beamid::experiments
