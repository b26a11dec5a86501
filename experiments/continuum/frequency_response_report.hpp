// What `beamid frf` prints and writes.
#pragma once

#include "experiments/continuum/frequency_responses.hpp"
#include "experiments/output/results.hpp"

namespace beamid::experiments {

/// The table resonances, frf.csv, results.json, and a figure of magnitude and phase.
Results report(const Experiment& experiment, const FrequencyResponses& found);

}  // namespace beamid::experiments
