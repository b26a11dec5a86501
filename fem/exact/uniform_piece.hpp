// Harmonic motion of a uniform piece of a beam, exactly.
#pragma once

#include <Eigen/Core>

namespace beamid::fem {

/// The amplitudes at a section of a beam in harmonic motion of frequency omega: deflection w, rotation theta,
/// and the forces conjugate to them on the part of the beam to its left, vertical force V and bending moment
/// M.
using HarmonicState = Eigen::Vector4d;

/// Units that make the four amplitudes of like size: (w / length, theta, V length^2 / EI, M length / EI).
struct StateScale {
  double length = 1.0;             ///< [m]
  double bending_stiffness = 1.0;  ///< [N m2]
};

/// Timoshenko's beam under an axial load P whose line of action turns with the axis,
///
///     w' = (theta + phi V) / (1 - phi P)      V' = -omega^2 rho A w
///     theta' = M / EI                         M' = -V - P w' - omega^2 rho I theta,      phi = 1 / kappa G
///     A;
///
/// phi = 0 is Euler-Bernoulli's, rho I = 0 neglects rotary inertia. With constant coefficients, y(x + h) =
/// exp(A h) y(x): one formula below and above the frequency at which Timoshenko's waves change their kind.
struct UniformPiece {
  double length = 0.0;             ///< [m]
  double bending_stiffness = 0.0;  ///< EI [N m2]
  double mass_per_length = 0.0;    ///< rho A [kg/m]
  double rotary_inertia = 0.0;     ///< rho I [kg m]
  double shear_flexibility = 0.0;  ///< phi [1/N]
  double axial_load = 0.0;         ///< P [N]

  /// A length no longer than 1 / wave_number [1/m] has no resonance at or below omega while its ends are
  /// held, as long as phi P < 0.4, and exp(A h) is of order one.
  double wave_number(double omega) const;

  /// A (4 x 4) of the scaled state and of x / scale.length.
  Eigen::Matrix4d rate(double omega, const StateScale& scale) const;
};

/// exp(X) by its series, for X of a piece not longer than 1 / wave_number: every entry to rounding, however
/// small.
Eigen::Matrix4d transition(const Eigen::Matrix4d& x);

/// exp(X) y, likewise.
HarmonicState advance(const Eigen::Matrix4d& x, const HarmonicState& y);

}  // namespace beamid::fem
