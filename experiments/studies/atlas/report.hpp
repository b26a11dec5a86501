// The atlas as a report.
#pragma once

#include "experiments/results/results.hpp"
#include "experiments/studies/atlas/atlas.hpp"

namespace beamid::experiments {

Results report(const Atlas& atlas);

}  // namespace beamid::experiments
