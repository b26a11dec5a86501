// Which coordinates a method means by positions along a beam.
#pragma once

#include <string>
#include <vector>

#include "fem/structural_system.hpp"

namespace beamid::reduction {

/// Deflection coordinates at the nodes nearest to `positions` [m]; without positions, those that the system's
/// outputs read, in their order and each once. Output rows that read more than one displacement (strains,
/// curvatures) are left out.
/// @param owner for messages: "reduction 'guyan'".
/// @throws std::invalid_argument when the system has no mesh, a position is not finite, off the beam or
/// nearest to a node that a support holds, two positions have the same nearest node, or there are no outputs.
std::vector<int> master_coordinates(const fem::StructuralSystem& system, const std::vector<double>& positions,
                                    const std::string& owner);

/// All coordinates, deflections and rotations, of the same nodes.
std::vector<int> interface_coordinates(const fem::StructuralSystem& system,
                                       const std::vector<double>& positions, const std::string& owner);

/// Columns of the system's inputs that are forces and not the acceleration of the base.
std::vector<int> force_inputs(const fem::StructuralSystem& system);

/// The column of the inputs that is the acceleration of the base across the beam; -1 where there is none.
int base_input(const fem::StructuralSystem& system);

}  // namespace beamid::reduction
