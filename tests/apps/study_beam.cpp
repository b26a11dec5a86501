#include "tests/apps/study_beam.hpp"

#include <cmath>
#include <numbers>

namespace beamid::apps {

double study_beam_frequency_hz(double root) {
  return root * root / (2 * std::numbers::pi) * std::sqrt(228.96 / (3.055 / 1.1 * std::pow(1.1, 4)));
}

}  // namespace beamid::apps
