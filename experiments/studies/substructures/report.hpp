// A structure identified part by part, as a user sees it.
#pragma once

#include "experiments/identify/parts/parts.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// First whether the parts may be trusted and what taking their sections for exact would have made of them;
/// then the joined parameters beside the whole structure's, and every part both ways with its bounds.
Results substructures_report(const Experiment& experiment, const PartedIdentification& found);

}  // namespace beamid::experiments
