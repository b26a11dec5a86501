// Estimates of a family of beams as text, tables, figures and JSON.
#pragma once

#include "experiments/identify/family/beam_family.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// Tables, figures, words and results.json keys.
Results report(const BeamFamily& family);

}  // namespace beamid::experiments
