// A comparison as text, tables, figures and JSON.
#pragma once

#include "experiments/output/results.hpp"
#include "experiments/record_comparison/comparison.hpp"

namespace beamid::experiments {

/// Tables, figures, words and results.json keys.
Results report(const Experiment& experiment, const Comparison& comparison);

}  // namespace beamid::experiments
