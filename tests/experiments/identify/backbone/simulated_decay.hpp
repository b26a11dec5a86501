// Free decays whose force law is known, by the textbook Runge-Kutta formula in fine steps, not by the
// project's schemes.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>

#include "experiments/record/record.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments::simulated_decay {

inline constexpr double mass = 1.0806, stiffness = 500, bend = 0.01;  // [kg], [N/m], x_r [m]

/// K x / (1 + |x| / x_r)
inline double hyperbolic(double x) {
  return stiffness * x / (1 + std::abs(x) / bend);
}

struct Decay {
  std::function<double(double)> backbone = hyperbolic;
  bool masing = false;  ///< branches from reversal to reversal at twice the scale
  double damping_ratio = 0.01, start = 0.03, seconds = 20, rate = 200,
         noise = 0.01;  ///< of the largest reading
  Quantity quantity = Quantity::displacement;
  double second_mode = 0;  ///< amplitude relative to the start, at 1.3 times the frequency
};

inline Record decay_record(const Decay& truth, std::uint64_t seed) {
  using Eigen::Index;
  const double c = 2 * truth.damping_ratio * std::sqrt(stiffness * mass), h = 1 / (truth.rate * 16);
  const auto n = static_cast<Index>(truth.rate * truth.seconds);
  double x = truth.start, v = 0, from = truth.start, force_from = truth.backbone(truth.start);
  const auto force = [&](double at) {
    return truth.masing ? force_from + 2 * truth.backbone(0.5 * (at - from)) : truth.backbone(at);
  };
  const auto pull = [&](double at, double speed) { return -(force(at) + c * speed) / mass; };
  Record record;
  record.time = Eigen::VectorXd::LinSpaced(n, 0, static_cast<double>(n - 1) / truth.rate);
  record.samples.resize(1, n);
  record.channels = {{truth.quantity, "mass"}};
  for (Index k = 0; k < n; ++k) {
    record.samples(0, k) = truth.quantity == Quantity::acceleration ? pull(x, v)
                           : truth.quantity == Quantity::velocity   ? v
                                                                    : x;
    for (int i = 0; i < 16; ++i) {
      const double before = v, k1x = v, k1v = pull(x, v), k2x = v + 0.5 * h * k1v,
                   k2v = pull(x + 0.5 * h * k1x, k2x), k3x = v + 0.5 * h * k2v,
                   k3v = pull(x + 0.5 * h * k2x, k3x), k4x = v + h * k3v, k4v = pull(x + h * k3x, k4x);
      const double next = v + h / 6 * (k1v + 2 * k2v + 2 * k3v + k4v);
      const double moved = x + h / 6 * (k1x + 2 * k2x + 2 * k3x + k4x);
      if (truth.masing && before * next < 0) {  // the reversal, where the straight line of v is zero
        const double part = before / (before - next), at = x + part * (moved - x);
        force_from = force(at), from = at;
      }
      x = moved, v = next;
    }
  }
  const double size = record.samples.cwiseAbs().maxCoeff();
  const double w = 1.3 * std::sqrt(stiffness / mass);
  for (Index k = 0; k < n; ++k)
    record.samples(0, k) +=
        truth.second_mode * size * std::exp(-0.01 * w * record.time[k]) * std::cos(w * record.time[k]);
  record.samples.row(0) += truth.noise * size * standard_normal(n, seed, 0).transpose();
  return record;
}

}  // namespace beamid::experiments::simulated_decay
