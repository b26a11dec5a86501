// What the modes determine of the parameters.
#pragma once

#include "experiments/identify/update/updating.hpp"

namespace beamid::experiments {

/// Fills in values, intervals, bounds, open directions, freedom and chi^2 limit of the first set, from the
/// singular values of its Jacobian over the parameters that are not held by a bound: a direction whose
/// standard deviation is above open_deviation is open.
void judge_parameters(const FitResidual& residual, Updating& result);

}  // namespace beamid::experiments
