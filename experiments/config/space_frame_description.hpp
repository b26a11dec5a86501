// A space frame in a sentence, and its members, worked out.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "fem/space_frame.hpp"

namespace beamid::experiments {

/// Its members, worked out: lengths, stiffnesses, masses, and where z of their sections points.
nlohmann::ordered_json describe_members(const fem::SpaceFrame& frame);

/// How much of it there is, its mass, what holds it, mesh.
std::string space_frame_text(const fem::SpaceFrame& frame, int elements_per_member, Eigen::Index coordinates);

/// Of members and bodies [kg].
double total_mass(const fem::SpaceFrame& frame);

}  // namespace beamid::experiments
