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

// What forward Euler does to damping where displacement and velocity are both observed.

/// The limit under process noise on the motion far above the sensors': every sample is taken as the state,
/// and one step of the velocity is regressed on the sample before it,
///
///     K_f = -Phi_21 M / dt,   C_f = (1 - Phi_22) M / dt,   Phi = e^(A dt)
///
/// so that C_f - C = K dt / 2 (1 - 4 xi^2) + ..., half of what the free motion alone gives.
/// @throws std::invalid_argument on a truth that does not oscillate.
Oscillator regressed_by_forward_euler(const Oscillator& truth, double dt);

/// The limit without process noise, light damping, a decay that is recorded to its end: the least squares of
/// two histories that no forward-Euler motion has at once. With epsilon = lambda - lambda_f,
///
///     lambda_found = lambda_f + 4 xi^2 q / (1 + q)^2 (epsilon + epsilon* e^(-2 i phi)),
///     C_found - C = K dt [1 - 4 xi^2 q / (1 + q)^2 (1 + cos 2 phi)]
///
/// to first order in dt and second in xi.
/// @param weight q = w^2 R_x / R_v: what velocity says of the motion over what displacement says
/// @param phase of the displacement at the first sample, phi [rad]; 0: released from rest
/// @throws as seen_through().
Oscillator seen_in_two_histories(const Oscillator& truth, double dt, double weight, double phase);

}  // namespace beamid::experiments
