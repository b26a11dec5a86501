// What a driven record itself says against its measured inputs, though nobody stated it.
#pragma once

#include "experiments/identify/compare/compared_run.hpp"

namespace beamid::experiments {

/// Where the record is surely likelier with a clock late (likeliest_lag.hpp) or else with noise in its inputs
/// (noisy_input_fit.hpp): contradicted where that moves an unknown out of its 95 % interval, or where the lag
/// makes most of what is left; a warning where it moves one by more than a deviation.
void judge_inputs(const RunContext& context, ComparedRun& run);

}  // namespace beamid::experiments
