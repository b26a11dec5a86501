// From a beam to its finite-element equations of motion.
#pragma once

#include "fem/beam.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {

/// Hermite cubic elements of equal length h with consistent mass, the root clamped.
///
/// Coordinates (n = 2 x elements), node after node from the first one beyond the root: deflection w [m] and
/// scaled rotation h theta [m]. Natural strains of an element between nodes 1 and 2 are its end rotations
/// against the chord, (h theta_1 - (w_2 - w_1), h theta_2 - (w_2 - w_1)), with D = EI/h^3 [4 2; 2 4]
/// [argyris1979]. One input, the tip force [N]; one output, the tip deflection [m].
///
/// @throws std::invalid_argument when the beam is impossible or elements < 1.
StructuralSystem assemble(const Beam& beam, int elements);

/// Deflection [m] at the nodes, the root included, of the motion q (n): (elements + 1).
Eigen::VectorXd nodal_deflection(const StructuralSystem& system, const Eigen::VectorXd& q);

/// Rotation [rad] at the nodes, the root included, of the motion q (n): (elements + 1).
Eigen::VectorXd nodal_rotation(const StructuralSystem& system, const Eigen::VectorXd& q);

/// Position [m] of the nodes, the root included: (elements + 1).
Eigen::VectorXd nodal_position(const StructuralSystem& system);

}  // namespace beamid::fem
