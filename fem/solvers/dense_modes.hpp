// All modes of a small system.
#pragma once

#include <Eigen/Core>

#include "fem/solvers/rigid_complement.hpp"
#include "fem/stiffness_solver.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {

/// Shapes (n x m) of all modes that are not rigid, frequencies ascending; m is n less the rigid-body motions
/// and less what has no mass.
///
/// With Z (n x (n-k)) an M-orthonormal basis of the complement of the rigid-body motions and D = U^T U, they
/// are Z times the right singular vectors of U B Z, whose singular values are the frequencies themselves and
/// not their squares. Where an axial load has made D indefinite, Z times the eigenvectors of (B Z)^T D (B Z).
/// Where M is only semidefinite, eigenvectors of the flexibility K^-1 against M.
Eigen::MatrixXd all_shapes(const StructuralSystem& system, const StiffnessSolver& solver,
                           const RigidComplement& complement);

}  // namespace beamid::fem
