// A record before and after its preparation.
#pragma once

#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/results/figure.hpp"

namespace beamid::experiments {

/// The first channel that is no force in time, and its spectrum where it is evenly sampled.
Figure preparation_figure(const PreparedRecord& prepared);

/// The row of that channel; 0 where all are forces.
Eigen::Index motion_row(const Record& record);

}  // namespace beamid::experiments
