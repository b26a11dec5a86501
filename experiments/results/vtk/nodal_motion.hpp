// The motion of a mesh in space.
#pragma once

#include <Eigen/Core>

#include "fem/structural_system.hpp"

namespace beamid::experiments {

/// Motion of every node: the translation (u, 0, w) and the rotation vector (0, -theta, 0). A plane frame's
/// motion along its y is the w here. Of a space frame all six, along its own axes.
struct NodalMotion {
  Eigen::Matrix3Xd translation;  ///< (3 x nodes) [m]
  Eigen::Matrix3Xd rotation;     ///< (3 x nodes) [rad]
};

/// Place of every node, (x, 0, y) in terms of the mesh, (x, y, z) of a spatial one: (3 x nodes) [m].
/// @throws std::invalid_argument when the system has no mesh (a reduced one).
Eigen::Matrix3Xd nodal_places(const fem::StructuralSystem& system);

/// Of coordinates, or their velocities or accelerations, q (n).
/// @throws std::invalid_argument when q has another size.
NodalMotion nodal_motion(const fem::StructuralSystem& system, const Eigen::VectorXd& q);

/// Of a mode shape q (n), scaled so that the largest translation is 1. Its sign is settled too: at the first
/// node that moves so far, the largest component is positive. Where no node moves, the largest rotation
/// becomes 1.
NodalMotion scaled_mode(const fem::StructuralSystem& system, const Eigen::VectorXd& q);

}  // namespace beamid::experiments
