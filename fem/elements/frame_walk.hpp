// The order in which a frame's members are assembled.
#pragma once

#include <vector>

#include "fem/frame.hpp"

namespace beamid::fem {

/// One member on the way, from a joint that is known to another.
struct FrameStep {
  std::size_t member = 0;
  int from = 0, to = 0;   ///< joints
  bool reversed = false;  ///< from its second joint to its first
};

/// All members, each once, breadth first: each step starts at a joint that an earlier one reached, or at the
/// start of a part of the frame that is not connected to the earlier ones. It starts where most is held.
std::vector<FrameStep> walk(const Frame& frame);

}  // namespace beamid::fem
