// A comparison as text, tables, figures and JSON.
#pragma once

#include "experiments/identify/compare/comparison.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

// Lags of channels with clocks of their own, for a report.

/// The lags as a table and as "clocks" in the values; nothing where all channels keep one clock.
void add_clocks(Results& results, const Comparison& comparison);

/// Tables, figures, words and results.json keys.
Results report(const Experiment& experiment, const Comparison& comparison);

}  // namespace beamid::experiments
