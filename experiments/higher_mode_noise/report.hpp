// Higher modes as noise: the report.
#pragma once

#include "experiments/higher_mode_noise/noise_study.hpp"
#include "experiments/output/results.hpp"

namespace beamid::experiments {

Results report(const NoiseStudy& study);

}  // namespace beamid::experiments
