// Many trials of one kind at once, side by side in the lanes of the processor's vectors.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "filters/algorithms/quantity.hpp"
#include "filters/filter_run.hpp"

namespace beamid::filters {

/// The damped oscillator M x'' + C x' + K x = 0 of known mass, its state [x, v, K, C] in [m, m/s, N/m, N
/// s/m], sampled exactly (algorithms/oscillator.hpp) or by explicit Euler steps
/// (algorithms/euler_oscillator.hpp).
struct OscillatorTrials {
  double mass = 1.0;               ///< M [kg]
  double interval = 1.0;           ///< between samples [s]
  std::vector<Quantity> observed;  ///< the outputs, in their order (p = 1, 2 or 3)
  Eigen::MatrixXd output_noise;    ///< R (p x p)
  Eigen::MatrixXd process_noise;   ///< Q per step (4 x 4); empty: none
  bool forward_euler = false;      ///< the scheme of that name instead of `exponential`
};

/// One record, and what was assumed before it.
struct LaneTrial {
  Eigen::MatrixXd outputs;  ///< y (p x N); NaN: not measured
  Gaussian initial;         ///< mean (4) and covariance (4 x 4)
};

/// Where a trial ended.
struct TrialResult {
  Gaussian last;                         ///< after the last sample, or after the last one before the failure
  double log_likelihood = 0.0;           ///< of all samples up to there
  std::optional<Eigen::Index> failed{};  ///< sample at which the innovation covariance lost its
                                         ///< positivity, or the estimate ceased to be finite
};

/// The extended Kalman filter on every trial: what `ekf` gives for each alone, to rounding. A trial that
/// fails leaves the others as they are.
/// @throws std::invalid_argument when shapes disagree, records differ in length, mass or interval are not
/// positive, or an initial covariance or noise is not symmetric positive semidefinite.
std::vector<TrialResult> run_batch(const OscillatorTrials& kind, const std::vector<LaneTrial>& trials,
                                   Start start = Start::at_first_sample);

/// One record of a ringing mode at even stamps, for filters that differ in their noise alone: the model
/// RingingOscillator of algorithms/oscillator.hpp, its state [y, y', k, xi, o].
struct RingingTrials {
  double frequency = 0.0;  ///< w_0 [rad/s]
  double interval = 0.0;   ///< between samples [s]
  Eigen::VectorXd signal;  ///< (N); NaN: not measured
  Gaussian initial;        ///< about the first sample: mean (5) and covariance (5 x 5)
};

/// ln p(signal) of the extended Kalman filter under each of these noises, Q (5 x 5) and R (1 x 1), side by
/// side: what `ekf` gives for each alone, to rounding; minus infinity where it fails.
/// @throws std::invalid_argument as run_batch() does
std::vector<double> ringing_log_likelihoods(const RingingTrials& kind, const std::vector<Noise>& noises);

/// Instructions that run_batch() uses on this processor: "avx2" or "baseline".
std::string batch_instructions();

}  // namespace beamid::filters
