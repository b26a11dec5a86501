// What `beamid frf` prints and writes.
#pragma once

#include "experiments/results/results.hpp"
#include "experiments/studies/continuum/frequency_responses.hpp"

namespace beamid::experiments {

/// The table resonances, frf.csv, results.json, and a figure of magnitude and phase.
Results report(const Experiment& experiment, const FrequencyResponses& found);

}  // namespace beamid::experiments
