// A shape known at some points, spread over the mesh.
#pragma once

#include <Eigen/Core>
#include <string>

#include "fem/structural_system.hpp"
#include "reduction/reduction.hpp"

namespace beamid::reduction {

/// Shapes S (n x p) such that S d is the motion of least strain energy through the deflections d (p) of the
/// training's points; supports hold. Between nodes the deflection is Hermite's cubic of the element's ends;
/// for slender uniform elements that is exactly how they bend. A point that a support holds has a zero
/// column.
/// @param owner for messages: "reduction 'pod'".
/// @throws std::invalid_argument when training is empty, of inconsistent sizes, not finite or zero, a point
/// is off the beam, given twice or said to move where a support holds it, the points do not hold the
/// structure's rigid-body motions, or the system has no mesh or is a frame.
Eigen::MatrixXd static_interpolation(const fem::StructuralSystem& system, const Training& training,
                                     const std::string& owner);

}  // namespace beamid::reduction
