// A comparison as text, tables, figures and JSON.
#pragma once

#include "experiments/identify/compare/comparison.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// Tables, figures, words and results.json keys.
Results report(const Experiment& experiment, const Comparison& comparison);

}  // namespace beamid::experiments
