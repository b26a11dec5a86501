#include "experiments/models/discretisation_bias.hpp"

#include <stdexcept>

#include "filters/scheme.hpp"

namespace beamid::experiments {

Oscillator seen_through(const std::string& scheme, const Oscillator& truth, double dt) {
  const double ratio = truth.damping_ratio();
  if (!(ratio > -1.0 && ratio < 1.0))
    throw std::invalid_argument("damping ratio is " + std::to_string(ratio) +
                                "; expected an oscillation, below 1");
  const auto method = filters::scheme_registry().make(scheme, {});
  return Oscillator::from_eigenvalue(truth.mass, filters::seen_through(*method, truth.eigenvalue(), dt));
}

}  // namespace beamid::experiments
