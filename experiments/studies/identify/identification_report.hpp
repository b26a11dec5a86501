// The report of one record identified with any model but K and C of a free decay.
#pragma once

#include "experiments/identify/compare/comparison.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// That of a comparison of one run, its status, what the filter's innovations say, and what was asked for
/// beside it: a smoother's history, the batch estimate.
Results identification_report(const Experiment& experiment, const Comparison& found);

}  // namespace beamid::experiments
