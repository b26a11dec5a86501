// The picture of what was tracked.
#pragma once

#include "experiments/identify/tracking/tracking.hpp"
#include "experiments/record/record.hpp"
#include "experiments/results/figure.hpp"

namespace beamid::experiments {

/// Signal, frequency with its band and the plateaus' means, damping ratio, against time.
Figure tracking_figure(const Tracking& found, const Channel& channel);

}  // namespace beamid::experiments
