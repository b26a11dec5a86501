// What a name might have been.
#pragma once

#include <string>
#include <vector>

namespace beamid::experiments {

/// "did you mean 'ukf'?" where a name is near, and then "known: rts, urts" only where they are few; else
/// "known: " and all of them. To stand behind "unknown filter 'ufk'; ".
std::string known_names(const std::string& word, const std::vector<std::string>& known);

}  // namespace beamid::experiments
