#include "experiments/models/discretisation_bias.hpp"

#include <complex>
#include <stdexcept>
#include <string>

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

Oscillator regressed_by_forward_euler(const Oscillator& truth, double dt) {
  const double xi = truth.damping_ratio(), w = truth.angular_frequency();
  if (!(std::abs(xi) < 1.0))
    throw std::invalid_argument("damping ratio is " + std::to_string(xi) +
                                "; expected an oscillation, below 1");
  // e^(A dt), second row: [-w^2 s / w_d, c - xi w s / w_d] e^(-xi w dt), s and c of w_d dt.
  const double damped = w * std::sqrt(1.0 - xi * xi), decay = std::exp(-xi * w * dt),
               s = std::sin(damped * dt) / damped, c = std::cos(damped * dt);
  const double by_displacement = -w * w * s * decay, by_velocity = (c - xi * w * s) * decay;
  return {truth.mass, -by_displacement * truth.mass / dt, (1.0 - by_velocity) * truth.mass / dt};
}

Oscillator seen_in_two_histories(const Oscillator& truth, double dt, double weight, double phase) {
  const double xi = truth.damping_ratio();
  const std::complex<double> alone = seen_through("forward_euler", truth, dt).eigenvalue(),
                             missing = truth.eigenvalue() - alone;
  const double share = 4.0 * xi * xi * weight / ((1.0 + weight) * (1.0 + weight));
  return Oscillator::from_eigenvalue(
      truth.mass, alone + share * (missing + std::conj(missing) * std::polar(1.0, -2.0 * phase)));
}

}  // namespace beamid::experiments
