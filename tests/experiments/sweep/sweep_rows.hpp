// Plans and rows of sweeps, made by hand.
#pragma once

#include <string>
#include <vector>

#include "experiments/sweep/rows.hpp"

namespace beamid::experiments {

SweepPlan plan_with(const std::vector<std::string>& vary, int samples = 1, int seeds = 1);

/// The same, all cases identified at once (`once` of the plan).
SweepPlan once(SweepPlan plan);

/// Of a stiffness of 10 N/m with a deviation and a bound of 1 N/m.
SweepRow found_row(std::size_t number, double estimate);

SweepRow unfound_row(std::size_t number, const std::string& status);

}  // namespace beamid::experiments
