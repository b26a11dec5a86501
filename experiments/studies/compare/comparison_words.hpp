// What a comparison says, in words.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/compare/comparison.hpp"

namespace beamid::experiments {

/// A paragraph each: what every reduction cost in accuracy and saved in time against the largest model, and
/// what the discretisations did.
std::vector<std::string> words(const Comparison& comparison);

/// The run that the others are measured against: no reduction where there is one, else the most coordinates.
/// Null when nothing converged.
const ComparedRun* reference_run(const Comparison& comparison);

}  // namespace beamid::experiments
