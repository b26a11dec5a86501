#include "tests/experiments/damped_oscillation.hpp"

#include <cmath>
#include <numbers>

namespace beamid::test {

std::complex<double> complex_rate(double frequency_hz, double damping_ratio) {
  return 2 * std::numbers::pi * frequency_hz *
         std::complex<double>(-damping_ratio, std::sqrt(1 - damping_ratio * damping_ratio));
}

Eigen::VectorXd damped_oscillation(std::complex<double> amplitude, std::complex<double> rate, double interval,
                                   Eigen::Index count, double start) {
  Eigen::VectorXd signal(count);
  for (Eigen::Index k = 0; k < count; ++k)
    signal[k] = (amplitude * std::exp(rate * (start + interval * static_cast<double>(k)))).real();
  return signal;
}

}  // namespace beamid::test
