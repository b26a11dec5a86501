// Stiffness and damping that change in time: plateaus, changes, and a history with its band.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "experiments/text/progress.hpp"

namespace beamid::experiments {

struct TrackSettings {
  std::optional<std::pair<double, double>> band_hz = {};  ///< where the mode may be; absent: track_band()
  /// Relative change of the stiffness per square root of a second; absent: what the likelihood of each
  /// plateau says.
  std::optional<double> walk = {};
  double false_alarms = 0.01;  ///< probability of a change found in a record that has none and white noise
  double shortest_cycles = 8;  ///< of a plateau
};

/// A span between two changes.
struct Plateau {
  Eigen::Index first = 0, last = 0;  ///< samples of the history
  double from = 0, to = 0;           ///< [s]
  /// Mean over the span, of the logarithm for the frequency; deviations include the wandering and, where the
  /// modal analysis is further away than three of them or has found another mode beside, its distance.
  double frequency_hz = 0, frequency_deviation_hz = 0;
  double damping_ratio = 0, damping_ratio_deviation = 0;
  /// Of the span as a free decay with constant stiffness, modes beside it fitted along; NaN where that fails.
  double modal_frequency_hz = 0, modal_damping_ratio = 0;
  std::vector<double> companions_hz;            ///< those modes
  double amplitude_from = 0, amplitude_to = 0;  ///< of the mode at both ends [unit of the signal]
  double noise = 0;                             ///< standard deviation [unit of the signal]
  double noise_relative_deviation = 0;          ///< of that estimate; infinite where the record does not tell
  double walk = 0;                              ///< [1/sqrt(s)]
  double force = 0;                             ///< of unmeasured excitation [unit/s2 sqrt(s)]
};

struct Tracking {
  std::pair<double, double> band_hz;
  int decimation = 1;
  double sway = 0;  ///< root mean square of what moves below the band and was taken out [unit of the signal]
  double interval = 0;   ///< of the history [s]
  double noise = 0;      ///< that changes were sought with [unit of the signal]
  double threshold = 0;  ///< of the sum of `test_samples` normalised squares
  Eigen::Index test_samples = 0;
  Eigen::VectorXd time, signal;                       ///< (M) low-passed
  Eigen::VectorXd frequency_hz, frequency_deviation;  ///< smoothed (M); deviation of its logarithm
  Eigen::VectorXd damping_ratio, damping_ratio_deviation;
  std::vector<Eigen::Index> alarms;  ///< samples at which motion and stiffness were taken up anew
  std::vector<Plateau> plateaus;
};

/// The octaves on both sides of the median frequency that dominates in 32 spans of the record [Hz].
/// @throws std::invalid_argument when the signal is shorter than 512 samples.
std::pair<double, double> track_band(const Eigen::VectorXd& signal, double interval);

/// Low-pass and decimate; where the signal sways below the band by more than half of the noise, take that
/// out, with two cycles at each end (without_sway() twice, at the middle of the band); follow the mode by an
/// extended Kalman filter on the ringing model, taking it up anew at every alarm (find_segments); tune noise,
/// unmeasured force and walk of every span long enough by maximum likelihood, and smooth it. Spans shorter
/// than that are no plateaus: their band is what few samples tell.
/// @throws std::invalid_argument when a setting makes no sense or the signal is too short.
Tracking track(const Eigen::VectorXd& signal, double start, double interval, const TrackSettings& settings,
               const Progress& progress = {});

}  // namespace beamid::experiments
