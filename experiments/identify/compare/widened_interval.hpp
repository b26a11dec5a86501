// A parameter's 95 % interval, as wide as its noise asks for.
#pragma once

#include "experiments/identify/compare/comparison.hpp"

namespace beamid::experiments {

/// Of parameter j, from its deviation in the state, `spread` times as wide; the parameter's own form makes it
/// lopsided.
void set_interval(ComparedRun& run, std::size_t j, double spread);

/// A standard deviation over the least there is, that of the Cramer-Rao bound and what was known beforehand;
/// 1 where it is not clearly below that, as chance and linearisation allow. Below 1 a filter is
/// overconfident.
double overconfidence(double deviation, double bound, double prior_deviation);

}  // namespace beamid::experiments
