#include "experiments/signal/positive.hpp"

#include <cmath>
#include <stdexcept>

namespace beamid::experiments {

void require_positive(double value, const std::string& name) {
  if (!(value > 0.0 && std::isfinite(value)))
    throw std::invalid_argument(name + ": " + std::to_string(value) + "; expected a positive number");
}

}  // namespace beamid::experiments
