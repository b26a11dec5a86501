// The picture of what was tracked.
#pragma once

#include "experiments/output/figure.hpp"
#include "experiments/record.hpp"
#include "experiments/tracking/tracking.hpp"

namespace beamid::experiments {

/// Signal, frequency with its band and the plateaus' means, damping ratio, against time.
Figure tracking_figure(const Tracking& found, const Channel& channel);

}  // namespace beamid::experiments
