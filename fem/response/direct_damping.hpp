// Damping in methods that integrate the equations as they are.
#pragma once

#include <string>

#include "fem/response/method.hpp"

namespace beamid::fem {

/// alpha and beta of the law.
/// @throws std::invalid_argument, naming the method, when the law has no sparse matrix or lets the first
/// mode, or modes of high frequency, gain energy.
ProportionalDamping direct_damping(const ResponseProblem& problem, const std::string& method);

}  // namespace beamid::fem
