// The beam as a researcher describes it: lengths, stiffness and masses in SI units.
#pragma once

namespace beamid::fem {

/// A uniform Euler-Bernoulli cantilever with a rigid tip body.
///
///     root (clamped) |=============================( M, J )   tip
///                    |<---------- length -------->|
///
/// The tip body's centre of mass lies on the beam's end.
struct Beam {
  double length = 0.0;              ///< L [m]
  double bending_stiffness = 0.0;   ///< E I [N m2]
  double mass_per_length = 0.0;     ///< rho A [kg/m]
  double tip_mass = 0.0;            ///< M [kg]
  double tip_rotary_inertia = 0.0;  ///< J about the tip mass's own centre [kg m2]

  double mass() const { return mass_per_length * length; }  ///< of the beam alone [kg]

  /// Static stiffness at the tip, 3 E I / L^3 [N/m].
  double tip_stiffness() const { return 3.0 * bending_stiffness / (length * length * length); }
};

/// Second moment of area of a rectangle about its own axis, width x height^3 / 12 [m4].
inline double rectangle_second_moment(double width, double height) {
  return width * height * height * height / 12.0;
}

/// @throws std::invalid_argument naming the first quantity that is not finite or has an impossible sign.
void validate(const Beam& beam);

}  // namespace beamid::fem
