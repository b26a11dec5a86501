// How long work says what it is doing, without knowing whether anyone watches.
#pragma once

#include <functional>
#include <string>

namespace beamid::experiments {

/// Called with a few words whenever another part of the work begins.
using Progress = std::function<void(const std::string&)>;

/// Nobody watches.
inline void unwatched(const std::string&) {}

}  // namespace beamid::experiments
