// How many moments, or allocations, a fault is tried at: few in the ordinary suite, all in tests/full.
#pragma once

#include <cstdlib>

namespace beamid::reliability {

/// @param few unless BEAMID_FAULTS is set, then `all`.
inline int moments(int few, int all) {
  return std::getenv("BEAMID_FAULTS") ? all : few;
}

}  // namespace beamid::reliability
