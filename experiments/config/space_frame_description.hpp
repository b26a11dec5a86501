// A space frame in a sentence, and in full, as results.json holds it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "fem/space_frame.hpp"

namespace beamid::experiments {

/// Every quantity of the frame, worked out; joints by their number, from 1. What it does not have is left
/// out.
nlohmann::ordered_json describe(const fem::SpaceFrame& frame, int elements_per_member);

/// How much of it there is, its mass, what holds it, mesh.
std::string space_frame_text(const fem::SpaceFrame& frame, int elements_per_member, Eigen::Index coordinates);

/// Of members and bodies [kg].
double total_mass(const fem::SpaceFrame& frame);

}  // namespace beamid::experiments
