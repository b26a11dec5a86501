// 95 % intervals of parameters, as wide as the record's noise asks for.
#pragma once

#include "experiments/identify/compare/compared_run.hpp"

namespace beamid::experiments {

/// Of parameter j, from its deviation in the state, `spread` times as wide; the parameter's own form makes it
/// lopsided.
void set_interval(ComparedRun& run, std::size_t j, double spread);

/// A standard deviation over the least there is, that of the Cramer-Rao bound and what was known beforehand;
/// 1 where it is not clearly below that, as chance and linearisation allow. Below 1 a filter is
/// overconfident.
double overconfidence(double deviation, double bound, double prior_deviation);

/// Standard deviation and interval of parameter j times `factor`, or times what brings them to the least
/// there is, if that is more.
void widen(ComparedRun& run, std::size_t j, double factor);

/// Of all parameters and of the mode found, where the record's noise is denser than white noise of the
/// deviation that the filter assumes: near the mode (noise_near_mode.hpp) or, of a forced record, where each
/// parameter is determined (noise_in_estimates.hpp). A remark states the factors. Never narrower.
void widen_intervals(const RunContext& context, ComparedRun& run);

}  // namespace beamid::experiments
