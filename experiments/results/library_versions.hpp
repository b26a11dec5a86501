// What this program was made with.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace beamid::experiments {

/// "beamid", the compiler and the libraries whose headers tell it, with their versions.
std::vector<std::pair<std::string, std::string>> library_versions();

}  // namespace beamid::experiments
