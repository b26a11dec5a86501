// What a reduction does by itself to the mode that it is identified by.
#pragma once

#include <string>

#include "experiments/identify/compare/compared_run.hpp"

namespace beamid::experiments {

/// A filter fits the frequency that its reduced model has to that of the record. Where the model, reduced,
/// has another frequency than the structure with the same parameters, as a static shape's mass and stiffness
/// make it, it is the parameters that come out wrong, by about twice as much in a stiffness, and no interval
/// shows it. A sentence where that is more than three of the frequency's deviations; else empty, as for
/// models without a parameter of the structure.
std::string reduction_error(const RunContext& context, const ComparedRun& run);

}  // namespace beamid::experiments
