// One mode as any sensor shows it, with stiffness and damping that wander.
#pragma once

#include <memory>

#include "filters/discrete_model.hpp"

namespace beamid::experiments {

/// Free motion of one mode, whatever the sensor measures and in whatever unit:
///
///     y'' + 2 xi w y' + w^2 y = 0,   w^2 = (2 pi f_0)^2 e^k,   k' = xi' = o' = 0,   observed: y + o
///
/// State [y, y', a, b, k, xi, o]: signal and its rate, the integrals a' = k and b' = xi, relative stiffness
/// k = ln(K / K_0), damping ratio, offset. Over a span T with a = b = 0 at its start, a/T and b/T are the
/// means of k and xi with the right deviation, wander included. Process noise of y' is a force nobody
/// measured, that of k and xi their wandering. Moved exactly, with exact tangents.
namespace ringing {
enum State { signal, slope, stiffness_integral, damping_integral, stiffness, damping, offset, size };
}

/// @param frequency_hz f_0 @param interval [s] @param noise Q (7 x 7), R (1 x 1)
std::unique_ptr<filters::DiscreteModel> ringing_model(double frequency_hz, double interval,
                                                      filters::Noise noise);

}  // namespace beamid::experiments
