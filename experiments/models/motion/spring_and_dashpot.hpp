// A law of springs as that of an oscillator.
#pragma once

#include <memory>

#include "experiments/models/motion/oscillator_motion.hpp"
#include "experiments/models/springs/spring_law.hpp"

namespace beamid::experiments {

/// A spring by its law, and a dashpot beside it: F = r + C x', p = [K, C, ...].
std::shared_ptr<const OscillatorLaw> spring_and_dashpot(std::shared_ptr<const SpringLaw> spring);

}  // namespace beamid::experiments
