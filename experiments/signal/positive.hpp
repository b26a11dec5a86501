// A check that settings of studies share.
#pragma once

#include <string>

namespace beamid::experiments {

/// @throws std::invalid_argument "mass: -1.000000; expected a positive number"
void require_positive(double value, const std::string& name);

}  // namespace beamid::experiments
