// Two equal masses in a chain of springs from wall to wall, shaken by white noise.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "experiments/random.hpp"

namespace beamid::experiments::test {

/// Modes (1, 1) and (1, -1) / asymmetric outputs: displacements of the first mass and of 0.6 of the second.
struct ShakenChain {
  struct Mode {
    double frequency_hz, damping_ratio, shape_ratio;  ///< shape_ratio: smaller over larger output
  };
  double interval = 0.1;  ///< [s]

  std::array<Mode, 2> modes() const { return {Mode{1.0, 0.02, 0.6}, Mode{std::sqrt(3.0), 0.015, 0.6}}; }

  /// (2 x N) at rest first; each modal coordinate is an oscillation z_(k+1) = e^(s dt) z_k + complex white
  /// noise, which keeps poles exactly; readings carry 5 % of white noise.
  Eigen::MatrixXd record(Eigen::Index count, std::uint64_t seed) const {
    const Eigen::Index before = 600;  // to become stationary
    Eigen::MatrixXd outputs = Eigen::MatrixXd::Zero(2, count);
    for (int m = 0; m < 2; ++m) {
      const Mode mode = modes()[m];
      const double w = 2 * std::numbers::pi * mode.frequency_hz, d = mode.damping_ratio;
      const std::complex<double> step =
          std::exp(w * std::complex<double>(-d, std::sqrt(1 - d * d)) * interval);
      const Eigen::VectorXd noise = standard_normal(2 * (count + before), seed, 3 * m);
      std::complex<double> z = 0;
      for (Eigen::Index k = 0; k < count + before; ++k) {
        z = step * z + std::complex<double>(noise[2 * k], noise[2 * k + 1]);
        if (k < before) continue;
        outputs(0, k - before) += z.real();
        outputs(1, k - before) += (m == 0 ? 0.6 : -0.6) * z.real();
      }
    }
    const double size = std::sqrt(outputs.squaredNorm() / static_cast<double>(outputs.size()));
    for (int i = 0; i < 2; ++i)
      outputs.row(i) += 0.05 * size * standard_normal(count, seed, 20 + i).transpose();
    return outputs;
  }
};

}  // namespace beamid::experiments::test
