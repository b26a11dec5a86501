// What the measured input makes of the structure as described, beside what the record shows.
#pragma once

#include <string>

#include "experiments/identify/compare/compared_run.hpp"

namespace beamid::experiments {

/// From rest and at the guesses, y_d(t), with the gain rms(y_d) / rms(y) over all channels, each in units of
/// its own size. A description that is wrong by some per cent moves it by a factor of two at most under a
/// force of many frequencies; a unit by more.
/// @returns where a forced run has no estimate that makes the record: a sentence that names a gain beyond 4,
/// or a sign that is turned; else empty
std::string described_response_text(const RunContext& context, const ComparedRun& run);

}  // namespace beamid::experiments
