// The atlas as a report.
#pragma once

#include "experiments/atlas/atlas.hpp"
#include "experiments/output/results.hpp"

namespace beamid::experiments {

Results report(const Atlas& atlas);

}  // namespace beamid::experiments
