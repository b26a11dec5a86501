// Two equal masses in a chain of springs from wall to wall, shaken by white noise.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "experiments/signal/toolbox.hpp"

namespace beamid::test {

/// Modes (1, 1) and (1, -1) / asymmetric outputs: displacements of the first mass and of 0.6 of the second.
struct ShakenChain {
  struct Mode {
    double frequency_hz, damping_ratio, shape_ratio;  ///< shape_ratio: smaller over larger output
  };
  double interval = 0.1;  ///< [s]

  std::array<Mode, 2> modes() const { return {Mode{1.0, 0.02, 0.6}, Mode{std::sqrt(3.0), 0.015, 0.6}}; }

  /// (2 x N) at rest first; each modal coordinate is an oscillation z_(k+1) = e^(s dt) z_k + complex white
  /// noise, which keeps poles exactly; readings carry 5 % of white noise.
  Eigen::MatrixXd record(Eigen::Index count, std::uint64_t seed) const;
};

}  // namespace beamid::test
