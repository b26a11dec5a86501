// An identification from several records as text, tables, figures and JSON.
#pragma once

#include "experiments/output/results.hpp"
#include "experiments/record_identification/joint_identification.hpp"

namespace beamid::experiments {

/// Tables, figures, words and results.json keys.
Results report(const Experiment& experiment, const JointIdentification& joint);

}  // namespace beamid::experiments
