// The beam as a researcher describes it: segments, bodies, supports, springs and dashpots, in SI units.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "fem/section.hpp"

namespace beamid::fem {

/// A stretch of the beam with one section.
struct Segment {
  double length = 0.0;  ///< [m]
  Section section;
  double dashpot = 0.0;  ///< of a storey, between its two floors [N s/m]
};

/// A rigid body fixed to the beam. Its own centre of mass lies `eccentricity` beyond its position along the
/// axis.
struct Body {
  double position = 0.0;        ///< along the beam [m]
  double mass = 0.0;            ///< [kg]
  double rotary_inertia = 0.0;  ///< about its own centre of mass [kg m2]
  double eccentricity = 0.0;    ///< [m], positive towards the tip
};

/// Mass that rides on the beam without stiffening it.
struct AddedMass {
  double from = 0.0, to = 0.0;   ///< [m]
  double mass_per_length = 0.0;  ///< [kg/m]
};

/// What is held at zero: both (clamped), the deflection (pinned) or the rotation (guided).
struct Support {
  double position = 0.0;  ///< [m]
  bool deflection = true;
  bool rotation = true;
};

/// Between one point of the beam and the ground.
struct Spring {
  double position = 0.0;       ///< [m]
  double translational = 0.0;  ///< k [N/m]
  double rotational = 0.0;     ///< k [N m/rad]
  double cubic = 0.0;          ///< k3 of a force k w + k3 w^3 [N/m3]
};

/// Between one point of the beam and the ground.
struct Dashpot {
  double position = 0.0;       ///< [m]
  double translational = 0.0;  ///< c [N s/m]
  double rotational = 0.0;     ///< c [N m s/rad]
  double quadratic = 0.0;      ///< c2 of a force c w' + c2 |w'| w' [N s2/m2]
};

/// A mass on a spring that hangs on one point of the beam: a tuned absorber, a passenger, an instrument.
struct Absorber {
  double position = 0.0;   ///< [m]
  double mass = 0.0;       ///< [kg]
  double stiffness = 0.0;  ///< k of a force k (w_absorber - w) on the beam [N/m]
  double damping = 0.0;    ///< c of a force c (w_absorber - w)' [N s/m]
};

/// A local loss of bending stiffness: E I becomes (1 - loss) E I.
struct Damage {
  double from = 0.0, to = 0.0;  ///< [m]
  double loss = 0.0;            ///< 0 <= loss < 1
};

/// Consistent: from the element's own shape functions, frequencies err by h^4. Lumped: half of each element
/// at its ends, with the rotary inertia of the half; M is diagonal but for eccentric bodies, frequencies err
/// by h^2.
enum class MassModel { consistent, lumped };

/// A straight beam along x, x = 0 at its root; w is the deflection, theta = dw/dx the slope of the section.
struct Beam {
  std::vector<Segment> segments;  ///< from the root on
  std::vector<Body> bodies;
  std::vector<AddedMass> added_masses;
  std::vector<Support> supports;
  std::vector<Spring> springs;
  std::vector<Dashpot> dashpots;
  std::vector<Absorber> absorbers;
  std::vector<Damage> damages;
  double axial_load = 0.0;  ///< P [N], all along, positive in compression, dead: it keeps its direction
  MassModel mass_model = MassModel::consistent;
  bool shear_building = false;  ///< segments are storeys, without nodes inside (shear_building.hpp)

  double length() const;  ///< L [m]
  double mass() const;    ///< of the segments and of what rides on them, bodies excluded [kg]

  /// What a body at the tip has, the sum of those there.
  double tip_mass() const;
};

/// @throws std::invalid_argument naming the first quantity that is not finite, has an impossible sign or lies
/// off the beam.
void validate(const Beam& beam);

// The beam of the study: a uniform Euler-Bernoulli cantilever with a rigid tip body.

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

// Nodes and elements.

/// Lines cut into elements: in the plane, a straight beam on y = 0; or in space.
struct Mesh {
  struct Node {
    double x = 0.0, y = 0.0, z = 0.0;  ///< [m]
  };
  struct Element {
    int first = 0, second = 0;    ///< nodes
    int segment = 0;              ///< of the beam, or member of a frame
    double from = 0.0, to = 1.0;  ///< part of the segment that it covers, s as in Variation
    double length = 0.0;          ///< h [m], the same number for all elements between two breaks
    double remaining = 1.0;       ///< of the bending stiffness, below 1 where damaged
  };
  std::vector<Node> nodes;
  std::vector<Element> elements;
  bool spatial = false;  ///< a space frame's, which moves out of the plane of x and y

  Eigen::VectorXd positions() const;  ///< x of the nodes [m]

  /// The node at x. @throws std::invalid_argument when no node lies there, to 1e-9 of the beam's length.
  int node_at(double x) const;
};

/// Cuts a beam into `elements` of nearly equal length, with a node wherever something begins, ends or sits:
/// segments, bodies, supports, springs, dashpots, absorbers, damage, added mass, and the points [m] asked
/// for. Between two such breaks the elements are equally long. There are never fewer elements than breaks
/// demand.
/// @throws std::invalid_argument when the beam is impossible, elements < 1 or a point is off the beam.
Mesh cut(const Beam& beam, int elements, const std::vector<double>& points = {});

}  // namespace beamid::fem
