// From a beam to its finite-element equations of motion.
#pragma once

#include <string>
#include <vector>

#include "fem/beam.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {

/// Where forces act and motion is observed.
struct Point {
  std::string name;
  double position = 0.0;   ///< [m]
  std::string place = {};  ///< of a structure whose places have names and no positions
  bool rotates = false;    ///< of a beam: observed is its rotation [rad], what acts a moment [N m]
};

/// Finite elements (elements/element.hpp) over the mesh that cut() makes.
///
/// Coordinates, node after node from the root, those held by supports left out: deflection w [m] and scaled
/// rotation s theta [m], s being the length of the element before the node; then the displacement [m] of each
/// absorber there and the interior coordinates of the element beyond it. Each point is an input, a force [N]
/// called NAME_force, and an output, a deflection [m] called NAME_deflection, or a moment [N m], NAME_moment,
/// and a rotation [rad], NAME_rotation, of which the base's motion has no share; the last input is
/// base_acceleration [m/s2], the acceleration of all supports and grounded springs together, coordinates then
/// being relative to the base.
///
/// @throws std::invalid_argument when the beam is impossible, elements < 1, or a point is off the beam or
/// supported.
StructuralSystem assemble(const Beam& beam, int elements, const std::vector<Point>& points);

/// The same with one point: "tip", or where the tip's deflection is held or the tip is sharp "midspan", the
/// middle of the longest span.
StructuralSystem assemble(const Beam& beam, int elements);

/// The point that the short form uses.
Point natural_point(const Beam& beam);

/// Deflection [m] at every node of the mesh, zero where supported, of the motion q (n): (nodes).
Eigen::VectorXd nodal_deflection(const StructuralSystem& system, const Eigen::VectorXd& q);

/// Rotation [rad] at every node, likewise.
Eigen::VectorXd nodal_rotation(const StructuralSystem& system, const Eigen::VectorXd& q);

/// Displacement along x [m] at every node, likewise; zero but for frames.
Eigen::VectorXd nodal_axial(const StructuralSystem& system, const Eigen::VectorXd& q);

/// Of one kind of coordinate [m] or [rad] at every node, likewise.
Eigen::VectorXd nodal(const StructuralSystem& system, const Eigen::VectorXd& q, Coordinate::Kind kind);

// The same beam on a finer mesh.

/// The mesh with every element cut into so many of equal length. @throws std::invalid_argument when parts < 1
Mesh refined(const Mesh& mesh, int parts);

/// assemble() on refined(cut(beam, elements, ...), parts): finer by the same factor everywhere, which a cut
/// into parts * elements need not be.
StructuralSystem assemble_refined(const Beam& beam, int elements, int parts,
                                  const std::vector<Point>& points);

}  // namespace beamid::fem
