// What a measured force that is held, or straight, between its samples does to identified stiffness and
// damping.
#pragma once

#include <optional>
#include <vector>

#include "experiments/record/record.hpp"
#include "experiments/studies/atlas/atlas.hpp"

namespace beamid::experiments {

/// In closed form: an oscillator of known mass in steady motion x = H cos(w t), force f = cos(w t) at its
/// resonance, w^2 = K/M, both sampled every dt. A filter that moves exactly under its own path of the force
/// answers G(K', C'; e^(i w dt)), the transfer function from sample to sample, and finds the K', C' with
///
///     G(K', C'; e^(i w dt)) = H = 1 / (i C w)
///
/// To first order in 1/N, N samples a period and p = pi / N: held K'/K - 1 = 2 xi sin(p)^2 / p and C'/C =
/// sin(2p) / (2p); straight K' = K and C'/C = (sin(p)/p)^2. A band-limited force has no error.
/// @throws std::invalid_argument unless the mode oscillates and dt is less than half a period.
Bias predicted_hold_bias(InputPath path, const Oscillator& mode, double dt);

/// What an extended Kalman filter really ends with: 40 periods, noise-free, R small, several passes. Nothing
/// where it fails.
std::optional<Bias> measured_hold_bias(InputPath path, const Oscillator& mode, double dt);

/// One path at one step.
struct HoldPoint {
  InputPath path = InputPath::held;
  double samples_per_period = 0.0;
  Bias predicted;
  std::optional<Bias> measured;
};

/// The three paths at the mode's own step, then over samples per period; measured where the filter was run.
struct HoldPage {
  std::vector<HoldPoint> own, map;
};

HoldPage make_hold_page(const AtlasSettings& settings, const Progress& progress);

}  // namespace beamid::experiments
