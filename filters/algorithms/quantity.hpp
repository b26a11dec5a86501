// What a sensor on an oscillator gives.
#pragma once

namespace beamid::filters {

enum class Quantity { displacement, velocity, acceleration };

}  // namespace beamid::filters
