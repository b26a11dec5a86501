// Higher modes as noise: the report.
#pragma once

#include "experiments/results/results.hpp"
#include "experiments/studies/noise/noise_study.hpp"

namespace beamid::experiments {

Results report(const NoiseStudy& study);

}  // namespace beamid::experiments
