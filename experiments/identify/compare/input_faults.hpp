// What a record itself says against its clocks and its measured inputs, though nobody stated it.
#pragma once

#include "experiments/identify/compare/compared_run.hpp"

namespace beamid::experiments {

/// Where the record is surely likelier with a clock at another rate or, of a driven record, with one late
/// (likeliest_clock.hpp) or with noise in its inputs (noisy_input_fit.hpp): contradicted where that moves an
/// unknown out of its 95 % interval, or where a lag makes most of what is left; a warning where it moves one
/// by more than a deviation. A constant lag within a free decay is left alone: modes that are not in step,
/// as those of dashpots, look so.
void judge_inputs(const RunContext& context, ComparedRun& run);

}  // namespace beamid::experiments
