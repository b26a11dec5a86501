// The commented experiment files that `beamid new` writes.
#pragma once

#include <string>
#include <vector>

namespace beamid::apps {

/// "beam", "chain", "frame", "space_frame", "system".
const std::vector<std::string>& starter_structures();

/// The whole file for one of these.
std::string starter_file(const std::string& structure);

}  // namespace beamid::apps
