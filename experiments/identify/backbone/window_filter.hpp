// Stiffness and damping of one window of a decay by the joint filter.
#pragma once

#include "experiments/identify/backbone/sine_windows.hpp"

namespace beamid::experiments {

/// 1 / s^2 of an acceleration, 1 / s of a velocity, 1 of a displacement e^(s t).
std::complex<double> displacement_per(Quantity quantity, std::complex<double> rate);

/// K and C of the window with their deviations, by model sdof started at its damped sine; false where the
/// filter lost the motion.
/// @param noise standard deviation of a sample
bool filter_window(const SineWindow& sines, const DecimatedSignal& coarse, Quantity quantity, double mass,
                   double noise, AmplitudeWindow& to);

}  // namespace beamid::experiments
