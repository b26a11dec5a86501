// Whether the damping of a decay depends on its amplitude, and as what does.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "experiments/identify/backbone/amplitude_windows.hpp"

namespace beamid::experiments {

/// C(A) of the windows as c0 + c1 g(A), by least squares weighed with the windows' deviations.
struct DampingTrend {
  enum class Kind {
    none,  ///< constant: what is left of c0 alone is less than six times chance, or C changes by under 30 %
    friction,  ///< g = 1 / A: a force F of constant size dissipates 4 F A a cycle, as C = 4 F / (pi omega A)
    drag,      ///< g = A: c2 |x'| x' dissipates 8/3 c2 omega^2 A^3, as C = 8 c2 omega A / (3 pi)
    other      ///< neither takes three quarters of what c0 leaves
  };
  Kind kind = Kind::none;
  double constant = 0;     ///< c0 [N s/m]; of none and other the weighed mean
  double coefficient = 0;  ///< F [N] or c2 [N s2/m2]
  double deviation = 0;    ///< of the coefficient, with what the law leaves of C for its noise
};

DampingTrend damping_trend(const std::vector<AmplitudeWindow>& windows);

/// A sentence; empty where the damping is constant.
std::string damping_trend_text(const DampingTrend& trend, const std::vector<AmplitudeWindow>& windows);

}  // namespace beamid::experiments
