#include "experiments/models/truth_behind.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "filters/scheme.hpp"

namespace beamid::experiments {
namespace {

void refuse_unless_it_oscillates(const Oscillator& found) {
  if (!(std::abs(found.damping_ratio()) < 1.0))
    throw std::invalid_argument("damping ratio is " + std::to_string(found.damping_ratio()) +
                                "; expected an oscillation, below 1");
}

}  // namespace

Oscillator truth_behind(const std::string& scheme, const Oscillator& found, double dt) {
  refuse_unless_it_oscillates(found);
  if (!(dt > 0.0) || !(found.angular_frequency() * dt < std::numbers::pi))
    throw std::invalid_argument("step is " + std::to_string(dt) + " s, " +
                                std::to_string(found.frequency_hz() * dt) +
                                " of a period; expected above 0 and less than half of one");
  const auto method = filters::scheme_registry().make(scheme, {});
  const std::complex<double> factor = method->amplification(found.eigenvalue() * dt).value;
  return Oscillator::from_eigenvalue(found.mass, std::log(factor) / dt);
}

Oscillator truth_with_ratio(double ratio, double omega,
                            const std::function<Oscillator(const Oscillator&)>& seen) {
  // Every scheme shifts the ratio by nearly the same, whatever it is: d seen / d ratio is about 1.
  constexpr double largest = 0.999, exact = 1e-14;
  constexpr int most = 200;
  double truth = ratio;
  for (int k = 0; k < most; ++k) {
    truth = std::clamp(truth, -largest, largest);
    const double missing = ratio - seen(Oscillator::from_frequency(1.0, omega, truth)).damping_ratio();
    if (std::abs(missing) < exact) return Oscillator::from_frequency(1.0, omega, truth);
    truth += missing;
  }
  throw std::runtime_error("no damping ratio between -1 and 1 is seen as " + std::to_string(ratio));
}

}  // namespace beamid::experiments
