// Records of one degree of freedom that a measured force drives throughout.
#pragma once

#include <unsupported/Eigen/MatrixFunctions>

#include "experiments/models/oscillator.hpp"
#include "experiments/record/record.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::test {

/// Acceleration of M x'' + C x' + K x = f from rest, exact for a force that runs straight between samples:
/// [x v f f']' = [v, (f - K x - C v)/M, f', 0] by its exponential. The force is white noise of 1 N, held by a
/// running mean over three samples; `noise` is relative to the acceleration's root mean square.
experiments::Record driven_throughout(const experiments::Oscillator& oscillator, double duration, double rate,
                                      double noise, std::uint64_t seed);

}  // namespace beamid::test
