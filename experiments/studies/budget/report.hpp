// Error budgets as a report.
#pragma once

#include <vector>

#include "experiments/results/results.hpp"
#include "experiments/studies/budget/budget.hpp"

namespace beamid::experiments {

/// @param budgets one at least, of the same assumptions @param orders of the average
Results report(const std::vector<Budget>& budgets, int orders);

}  // namespace beamid::experiments
