// The beam of the study: a uniform Euler-Bernoulli cantilever with a rigid tip body.
#pragma once

#include "fem/beam.hpp"

namespace beamid::fem {

///     root (clamped) |=============================( M, J )   tip
///                    |<---------- length -------->|-e-|
struct Cantilever {
  double length = 0.0;              ///< L [m]
  double bending_stiffness = 0.0;   ///< E I [N m2]
  double mass_per_length = 0.0;     ///< rho A [kg/m]
  double tip_mass = 0.0;            ///< M [kg]
  double tip_rotary_inertia = 0.0;  ///< J about the tip mass's own centre [kg m2]
  double tip_eccentricity = 0.0;    ///< e of that centre beyond the tip, along the axis [m]

  double mass() const { return mass_per_length * length; }  ///< of the beam alone [kg]

  /// Static stiffness at the tip, 3 E I / L^3 [N/m].
  double tip_stiffness() const { return 3.0 * bending_stiffness / (length * length * length); }

  /// The same in general terms.
  operator Beam() const {
    Beam beam;
    beam.segments = {{length, {bending_stiffness, mass_per_length, 0.0, {}, {}, {}}}};
    beam.supports = {{0.0, true, true}};
    if (tip_mass != 0.0 || tip_rotary_inertia != 0.0)
      beam.bodies = {{length, tip_mass, tip_rotary_inertia, tip_eccentricity}};
    return beam;
  }
};

}  // namespace beamid::fem
