// What every discretisation does to identified stiffness and damping, over steps and damping ratios.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/models/oscillator.hpp"
#include "experiments/record/record.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

/// Relative errors of a filter on an exact record, 100 (found / true - 1) [%].
struct Bias {
  double stiffness_percent = 0.0;
  double damping_percent = 0.0;
};

/// In closed form (discretisation_bias.hpp); nothing where the step is too long for the scheme.
std::optional<Bias> predicted_bias(const std::string& scheme, const Oscillator& truth, double dt);

/// What an extended Kalman filter really ends with: noise-free displacements, R small, several passes.
/// Nothing where it fails.
std::optional<Bias> measured_bias(const std::string& scheme, const Oscillator& truth, double dt);

/// The longest w dt up to which the predicted error of C stays within `percent`; infinity where no step up to
/// half a period exceeds it.
double harmless_step(const std::string& scheme, double damping_ratio, double percent);

struct AtlasSettings {
  Oscillator beam;                                               ///< the user's: first mode
  double interval = 0.0;                                         ///< the user's dt [s]
  std::vector<double> damping_ratios{0.0015, 0.005, 0.02, 0.1};  ///< of the map
};

/// One scheme at one step and damping ratio.
struct AtlasPoint {
  std::string scheme;
  double damping_ratio = 0.0;
  double step = 0.0;  ///< w dt [rad]
  std::optional<Bias> predicted, measured;
};

struct Atlas {
  AtlasSettings settings;
  std::vector<AtlasPoint> own;  ///< the user's beam and dt, every scheme
  std::vector<AtlasPoint> map;  ///< every scheme and damping ratio, step by step; measured at some of them
};

/// @throws std::invalid_argument unless the beam oscillates and is sampled more than twice a period.
Atlas make_atlas(const AtlasSettings& settings, const Progress& progress);

// What a measured force that is held, or straight, between its samples does to identified stiffness and
// damping.

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
