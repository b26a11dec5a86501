// The mass that a hammer feels in a mode.
#pragma once

#include <optional>
#include <string>

#include "experiments/modal/study/modal_study.hpp"

namespace beamid::experiments {

/// A mode's mass at the point that is struck, m = 1 / phi^2 with phi the mass-normalised shape there.
struct HammerMass {
  double mass = 0, deviation = 0;         ///< [kg]
  double impulse = 0, velocity_step = 0;  ///< of the hit [N s], of the mode [m/s]
  std::vector<double> pulses_s;           ///< of the hit, after its onset
  std::string coarse;                     ///< what is said of a hit of few samples (hit_sampling.hpp)
};

/// From impulse and velocity step: after a force f(t) from rest the mode moves as
///
///     x(t) = Im(e^(s t) F) / (m w_d),   F = integral of f(t) e^(-s t) dt,   so   m = |s|^k |F| / (w_d A)
///
/// with A the mode's amplitude in displacement, velocity or acceleration (k = 0, 1, 2), taken back to the
/// hit: log A from the first window of its decay, with the damping rate there and its change up to the second
/// window (amplitude_dependence.hpp). The deviation is that of this way back and of what sampling leaves of F
/// (hit_sampling.hpp); the hammer's calibration is not in it.
/// @param record whole, with the force; the first channel of motion counts, taken to be where the hammer hits
/// @return nothing where the record has no force, no hit, a hit of too few samples or too short a decay;
/// `reason` says why
std::optional<HammerMass> hammer_mass(const Record& record, const Pole& pole,
                                      const std::vector<std::complex<double>>& others, std::string& reason);

}  // namespace beamid::experiments
