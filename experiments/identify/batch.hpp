// The yardstick: all samples at once, by the model that the filter has.
#pragma once

#include "experiments/identify/record_identification.hpp"

namespace beamid::experiments {

/// Output-error maximum likelihood (filters::estimate_batch) of initial motion, K, C and the sensor's bias,
/// without a prior, from the modal analysis' frequency and damping ratio. Its noise is the filter's.
BatchIdentification identify_batch(const RecordIdentification& found, const filters::Measurements& measured);

}  // namespace beamid::experiments
