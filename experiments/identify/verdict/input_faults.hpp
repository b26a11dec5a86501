// What a record itself says against its clocks and its measured inputs, though nobody stated it.
#pragma once

#include "experiments/identify/engine/compared_run.hpp"

namespace beamid::experiments {

/// Where a driven record is surely likelier with a clock late or at another rate (likeliest_clock.hpp), or
/// else with noise in its inputs (noisy_input_fit.hpp): contradicted where that moves an unknown out of its
/// 95 % interval, or where it makes most of what is left; a warning where it moves one by more than a
/// deviation.
void judge_inputs(const RunContext& context, ComparedRun& run);

/// What is said of them, and what to do.
std::string clock_scatter_text(const Record& record, const ClockScatter& scatter);

/// Contradicted where the channels of a free decay do not ring at one frequency (joint_decay_fit.hpp).
void judge_clock_scatter(const RunContext& context, ComparedRun& run);

}  // namespace beamid::experiments
