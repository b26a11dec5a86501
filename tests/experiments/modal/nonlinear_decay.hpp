// A decay whose damping and frequency follow its amplitude.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace beamid::test {

/// y = A cos(phase), A' = -d A - 0.02 A^power, phase' = w (1 + b A^2), from A = 5 and phase 0.3 on (count).
inline Eigen::VectorXd nonlinear_decay(double frequency_hz, double damping_ratio, double power, double b,
                                       double interval, Eigen::Index count) {
  const double w = 2 * std::numbers::pi * frequency_hz, d = damping_ratio * w;
  Eigen::VectorXd signal(count);
  double a = 5, phase = 0.3;
  for (Eigen::Index k = 0; k < count; ++k) {
    signal[k] = a * std::cos(phase);
    a -= interval * (d * a + (a > 0 ? 0.02 * std::pow(a, power) : 0.0));
    phase += interval * w * (1 + b * a * a);
  }
  return signal;
}

}  // namespace beamid::test
