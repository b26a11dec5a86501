// Filters against the bound as tables, a figure and numbers.
#pragma once

#include "experiments/results/results.hpp"
#include "experiments/studies/efficiency/efficiency.hpp"

namespace beamid::experiments {

/// rms error / bound with its 95 % interval, and bias.
Table efficiency_table(const Efficiency& all);
/// NEES with its 99.9 % band, coverage of 95 % intervals, runs lost with Wilson's interval.
Table consistency_table(const Efficiency& all);
/// rms error / bound over the damping ratio.
Figure efficiency_figure(const Efficiency& all);

Results report(const Efficiency& all);

}  // namespace beamid::experiments
