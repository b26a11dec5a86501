// What suggests that measured modes are not what they are taken for.
#pragma once

#include <string>
#include <vector>

namespace beamid::experiments {

struct UpdateStudy;

/// Sentences: frequencies in rad/s, a mode missing in between, a sensor with the wrong sign, a mass or unit
/// that is wrong by a factor, modes that no predicted one resembles.
std::vector<std::string> update_warnings(const UpdateStudy& study);

}  // namespace beamid::experiments
