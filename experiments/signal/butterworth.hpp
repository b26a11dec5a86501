// Butterworth filters by the bilinear transform.
#pragma once

#include "experiments/signal/cascaded_filter.hpp"

namespace beamid::experiments {

/// Digital Butterworth filters of order n, with W = tan(pi f dt) / tan(pi corner dt):
///
///     low-pass  |H|^2 = 1 / (1 + W^(2n))      high-pass  |H|^2 = 1 / (1 + W^(-2n))
///
/// from the analogue prototype [butterworth1930], prewarped so that half the power passes at the corner
/// itself. A band-pass is the cascade of both.
/// @param corner_hz [Hz], between 0 and half the sampling rate
/// @param interval sampling interval [s]
/// @throws std::invalid_argument when order is not 1 to 8, or corner or interval are out of range.
CascadedFilter butterworth_low_pass(int order, double corner_hz, double interval);
CascadedFilter butterworth_high_pass(int order, double corner_hz, double interval);

}  // namespace beamid::experiments
