// The tables of a comparison.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/compare/comparison.hpp"
#include "experiments/results/table.hpp"

namespace beamid::experiments {

/// A row for each run.
Table run_table(const Comparison& comparison);

/// One parameter, a row for each run.
Table parameter_table(const Comparison& comparison, const std::string& name);

/// One run, a row for each parameter. @param record that it is of
Table parameter_table(const ComparedRun& run, const Record& record);

/// Of all runs, each once.
std::vector<std::string> parameter_names(const Comparison& comparison);

}  // namespace beamid::experiments
