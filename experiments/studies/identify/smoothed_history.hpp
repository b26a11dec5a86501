// What the whole record says of every instant, as a file and a picture.
#pragma once

#include "experiments/identify/record_identification.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// smoothed.csv: time_s, then mean and standard deviation of every state at every sample.
Attachment smoothed_history(const Record& record, const RecordIdentification& found);

/// Displacement over the first six cycles, K and C over the record: the filter's and the smoother's, with
/// bands of 95 %.
Figure smoothed_figure(const Record& record, const RecordIdentification& found);

}  // namespace beamid::experiments
