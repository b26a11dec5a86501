// Which rotations of members' ends are free of their joints.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fem/space_frame.hpp"

namespace beamid::fem {

/// Directions in which a member's end turns without its joint, of length 1 and across each other, as columns
/// (3 x 0 to 3).
using ReleasedDirections = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;

/// Of each member at its first and at its second end. Where a direction is free of all members of a joint and
/// no support holds it, nothing would turn the joint: the first of these members keeps it.
std::vector<std::array<ReleasedDirections, 2>> released_ends(const SpaceFrame& frame);

}  // namespace beamid::fem
