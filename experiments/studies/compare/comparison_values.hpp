// What results.json has of a comparison.
#pragma once

#include <nlohmann/json.hpp>

#include "experiments/identify/compare/comparison.hpp"

namespace beamid::experiments {

/// "configuration": the experiment, how its record was identified, and the beam it was simulated from.
nlohmann::ordered_json comparison_configuration(const Experiment& experiment, const Comparison& comparison);

/// The record, the status of all runs together, converged where any is, and every run.
nlohmann::ordered_json comparison_values(const Comparison& comparison);

}  // namespace beamid::experiments
