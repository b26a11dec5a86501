// A structure whose properties are unknown: its equations and what each property does to them.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fem/assembly.hpp"
#include "fem/beam.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {

// Sparse matrices from entries that add up.

using Triplets = std::vector<Eigen::Triplet<double>>;

/// Entries at the same place are added.
inline SparseMatrix sparse(Eigen::Index rows, Eigen::Index columns, const Triplets& entries) {
  SparseMatrix matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  matrix.makeCompressed();
  return matrix;
}

/// A physical quantity of a beam that may be unknown.
struct BeamParameter {
  enum class Quantity {
    bending_stiffness,             ///< E I, mean over the region, all of it in proportion [N m2]
    tip_mass,                      ///< of the first body at the tip: others there, a sensor, keep theirs [kg]
    body_mass,                     ///< of all bodies in the region, in proportion [kg]
    tip_rotary_inertia,            ///< of the tip mass about its own centre [kg m2]
    root_rotational_stiffness,     ///< of an elastic root [N m/rad]
    root_translational_stiffness,  ///< of an elastic root [N/m]
    axial_load,                    ///< P, positive in compression [N]
    storey_stiffness,              ///< 12 E I / h^3, mean over the region's storeys, in proportion [N/m]
    storey_damping,                ///< of their dashpots, mean, in proportion [N s/m]
    factor                         ///< of a frame's group of members or a system's matrices, by name [-]
  };
  Quantity quantity = Quantity::bending_stiffness;
  std::optional<std::pair<double, double>> region;  ///< but for tip, root, load: from, to [m]; absent: all
  std::string name = {};                            ///< of a factor
};

/// What the beam has of it. @throws std::invalid_argument when it has no such thing (an elastic root, a body
/// with mass), or the region is off the beam or empty.
double value_of(const Beam& beam, const BeamParameter& parameter);

/// The beam with another value of it. Damage and variation along the region keep their proportions; a section
/// with shear deformation keeps the ratio of E I to kappa G A, as another Young's modulus would.
/// @throws std::invalid_argument as value_of, and when the value is impossible.
Beam with_value(const Beam& beam, const BeamParameter& parameter, double value);

/// The same beam, whose meshes have nodes there [m] beside those they need: its damages include some without
/// loss, which begin or end there.
/// @throws std::invalid_argument when a place is off the beam.
Beam with_nodes(const Beam& beam, const std::vector<double>& positions);

/// Equations that are affine in every parameter p_j, in M, in K, in E, and of dashpots in C:
///
///     M = M_0 + sum_j (p_j - p_0j) M_j,    K = K_0 + sum_j (p_j - p_0j) B^T D_j B
///
/// so that the derivatives are exact and hold for all values. B is that of the system, K_0 = B^T D_0 B, but
/// where the axial load is asked about and P_0 = 0: then it has the chords' strains too, which the system
/// does without.
struct ParametricSystem {
  StructuralSystem system;  ///< at p_0
  Eigen::VectorXd values;   ///< p_0 (q)
  SparseMatrix strain;      ///< B of the derivatives (s x n)

  struct Derivative {
    SparseMatrix mass;          ///< M_j (n x n)
    SparseMatrix rigidity;      ///< D_j (s x s)
    SparseMatrix inputs;        ///< E_j (n x m)
    SparseMatrix damping = {};  ///< C_j (n x n); empty: zero
  };
  std::vector<Derivative> derivatives;  ///< q

  /// K_j = B^T D_j B (n x n).
  SparseMatrix stiffness_derivative(std::size_t j) const {
    return strain.transpose() * derivatives[j].rigidity * strain;
  }
};

/// The mesh has nodes at the ends of all regions, so that the system may have more elements than assemble()
/// would make. The derivatives are differences of two assemblies on this mesh: exact to rounding, since the
/// dependence is affine.
/// @param beam with the parameters' values p_0.
/// @throws std::invalid_argument as assemble() and value_of(), and when a parameter has no effect (the mass
/// of a tip that is held).
ParametricSystem assemble_parametric(const Beam& beam, int elements, const std::vector<Point>& points,
                                     const std::vector<BeamParameter>& parameters);

/// Output row (1 x n) that reads the curvature theta' [1/m] (w'' without shear deformation) at a node of the
/// mesh; where the section changes there, the mean of both sides'. The bending strain on a surface at
/// distance c from the axis is -c theta'.
///
/// Each side's is the derivative of the polynomial through the rotations of up to five nodes from there on,
/// as far as segment, damage and element length stay the same: nodal rotations err by h^4, and with five
/// nodes theta' errs by h^4 as well, where the element's own curvature errs by h^2. A body, a spring or a
/// force inside that stretch makes theta'' jump, which the polynomial follows to the first order in h only.
/// @throws std::invalid_argument when no node lies there, or the system has no mesh.
SparseMatrix curvature_row(const StructuralSystem& system, double position);

// What a strain gauge reads.

/// curvature_row() of a beam's system, better at a clamp: there neither inertia nor springs load the beam,
/// and M'' = M''' = 0 makes the curvature at the end of the element's own shape, which errs by h^2 elsewhere,
/// err by h^4 with a far smaller factor than the polynomial's (modes 1, 3 and 12 of a cantilever of 40
/// elements: 3e-8, 9e-6 and 4e-3 instead of 6e-7, 1.6e-4 and 3e-2). That needs consistent mass, a section
/// that is uniform along the element, and no axial load.
/// @throws std::invalid_argument as curvature_row()
SparseMatrix gauge_row(const StructuralSystem& system, const Beam& beam, double position);

}  // namespace beamid::fem
