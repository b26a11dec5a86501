// What a discretisation does to identified stiffness and damping, in closed form.
#pragma once

#include <string>

#include "experiments/models/oscillator.hpp"

namespace beamid::experiments {

/// The oscillator that a filter moving by `scheme` finds in the exact free decay of `truth` sampled every dt
/// [s].
///
/// A one-step scheme of stability function g sees e^(lambda dt) as the motion of lambda_f with
/// g(lambda_f dt) = e^(lambda dt); hence K_f = M |lambda_f|^2 and C_f = -2 M Re lambda_f. For forward Euler
/// and light damping K_f/K - 1 = -xi w dt - (w dt)^2/12 and C_f - C = K dt: the error of the 2009 paper
/// [inverse2009].
/// @throws std::invalid_argument on an unknown scheme or a truth that does not oscillate;
///         std::runtime_error when dt is too long for the scheme.
Oscillator seen_through(const std::string& scheme, const Oscillator& truth, double dt);

/// Relative difference in per cent, 100 (found / reference - 1).
inline double percent(double found, double reference) {
  return 100.0 * (found / reference - 1.0);
}

}  // namespace beamid::experiments
