// A parameter's 95 % interval, as wide as its noise asks for.
#pragma once

#include "experiments/identify/compare/comparison.hpp"

namespace beamid::experiments {

/// Of parameter j, from its deviation in the state, `spread` times as wide; the parameter's own form makes it
/// lopsided.
void set_interval(ComparedRun& run, std::size_t j, double spread);

}  // namespace beamid::experiments
