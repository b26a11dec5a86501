// An oscillator as a structural system of one coordinate, which is what a reduction would have left.
#pragma once

#include "experiments/models/oscillator.hpp"
#include "fem/assembly.hpp"

namespace beamid::experiments {

/// M q'' + C q' + K q = u, y = q, all matrices 1 x 1. @throws std::invalid_argument unless K > 0.
fem::StructuralSystem one_coordinate(const Oscillator& oscillator);

}  // namespace beamid::experiments
