#include "fem/response/direct_damping.hpp"

#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "fem/modes.hpp"

namespace beamid::fem {

ProportionalDamping direct_damping(const ResponseProblem& problem, const std::string& method) {
  try {
    const ProportionalDamping law = proportional_coefficients(problem.damping);
    if (law.mass < 0.0) damping_ratios(problem.damping, modes(problem.system, 1).angular_frequency);
    if (law.stiffness < 0.0) {
      std::ostringstream message;
      message << name(problem.damping) << " damping: modes above "
              << std::sqrt(-law.mass / law.stiffness) / (2.0 * std::numbers::pi)
              << " Hz would have a negative damping ratio; expected anchors that let it rise with frequency";
      throw std::invalid_argument(message.str());
    }
    return law;
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(method + ": " + error.what());
  }
}

}  // namespace beamid::fem
