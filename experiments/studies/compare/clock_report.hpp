// Lags of channels with clocks of their own, for a report.
#pragma once

#include "experiments/identify/compare/comparison.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// The lags as a table and as "clocks" in the values; nothing where all channels keep one clock.
void add_clocks(Results& results, const Comparison& comparison);

}  // namespace beamid::experiments
