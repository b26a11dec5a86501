// An identification from several records as text, tables, figures and JSON.
#pragma once

#include "experiments/identify/family/beam_family.hpp"
#include "experiments/identify/joint_comparison.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

// A comparison over several records as text, tables, figures and JSON.

/// Tables, figures, words and results.json keys.
Results report(const Experiment& experiment, const JointComparison& joint);

// Estimates of a family of beams as text, tables, figures and JSON.

/// Tables, figures, words and results.json keys.
Results report(const BeamFamily& family);

/// Tables, figures, words and results.json keys.
Results report(const Experiment& experiment, const JointIdentification& joint);

}  // namespace beamid::experiments
