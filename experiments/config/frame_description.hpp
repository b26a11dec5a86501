// A plane frame in a sentence.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fem/frame.hpp"

namespace beamid::experiments {

/// "clamped", "rolling_x", ...: what a support holds. Rolling and sliding are along the axis they name,
/// rolling with and sliding without a rotation; a guide holds the rotation alone.
const std::vector<std::pair<std::string, fem::Frame::Support>>& frame_support_kinds();

/// The kind of a support; "free" where it is none of them.
std::string frame_support_kind(const fem::Frame::Support& support);

/// The frame in a sentence or two: how much of it there is, its mass, what holds it, mesh.
std::string frame_text(const fem::Frame& frame, int elements_per_member, Eigen::Index coordinates);

/// Of members and bodies [kg].
double total_mass(const fem::Frame& frame);

}  // namespace beamid::experiments
