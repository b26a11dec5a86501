// A comparison over several records as text, tables, figures and JSON.
#pragma once

#include "experiments/identify/joint_comparison.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// Tables, figures, words and results.json keys.
Results report(const Experiment& experiment, const JointComparison& joint);

}  // namespace beamid::experiments
