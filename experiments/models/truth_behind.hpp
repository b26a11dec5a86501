// The structure behind a published damping ratio: the closed form of a discretisation, backwards.
#pragma once

#include <functional>
#include <string>

#include "experiments/models/oscillator.hpp"

namespace beamid::experiments {

/// The oscillator whose exact free decay, sampled every dt [s], a filter moving by `scheme` takes for that of
/// `found`: e^(lambda dt) = g(lambda_f dt), seen_through() backwards. Its damping may be negative: no damped
/// motion gives `found`.
/// @throws std::invalid_argument on an unknown scheme, a `found` that does not oscillate, or less than two
/// samples a period.
Oscillator truth_behind(const std::string& scheme, const Oscillator& found, double dt);

/// The oscillator of angular frequency `omega` [rad/s] for which `seen` has the damping ratio `ratio`.
/// @param seen what a filter finds, of the truth; it may throw std::runtime_error where it finds nothing
/// @throws std::runtime_error when no damping ratio between -1 and 1 gives it.
Oscillator truth_with_ratio(double ratio, double omega,
                            const std::function<Oscillator(const Oscillator&)>& seen);

}  // namespace beamid::experiments
