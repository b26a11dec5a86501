// An identification from several records as text, tables, figures and JSON.
#pragma once

#include "experiments/identify/joint_identification.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// Tables, figures, words and results.json keys.
Results report(const Experiment& experiment, const JointIdentification& joint);

}  // namespace beamid::experiments
