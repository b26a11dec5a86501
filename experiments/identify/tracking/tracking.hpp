// Stiffness and damping that change in time: plateaus, changes, and a history with its band.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "experiments/text/progress.hpp"
#include "filters/noise_estimation.hpp"

namespace beamid::experiments {

// Where the motion changes: the filter started anew wherever its innovations say so.

/// What the spans of one record have in common.
struct Ringing {
  Eigen::VectorXd time, signal;  ///< (M)
  double interval = 0;           ///< [s]
  std::pair<double, double> band_hz;
  double centre_hz = 0;  ///< f_0 of the model
  double noise = 0;      ///< standard deviation that changes are sought with

  Eigen::Index size() const { return signal.size(); }
  /// So many cycles at the centre, in samples.
  Eigen::Index cycles(double count) const;
  /// Samples first .. last.
  filters::Measurements span(Eigen::Index first, Eigen::Index last) const;
};

/// A filter on the ringing model, registered under this name.
std::unique_ptr<filters::Filter> ringing_filter(const Ringing& ringing, const filters::Noise& noise,
                                                const std::string& method = "ekf");

/// What ringing_filter() by `ekf` finds of that span, without the two integrals, which no reading depends on:
/// five states, and several noises side by side.
filters::NoisyLikelihoods ringing_likelihoods(const Ringing& ringing, const filters::Measurements& span,
                                              const filters::Gaussian& initial);

/// @param force of unmeasured excitation [unit/s2 sqrt(s)] @param walk of ln K and of twice the damping ratio
/// [1/sqrt(s)]: a relative pole that wanders as far in any direction
filters::Noise ringing_noise(const Ringing& ringing, double noise, double force, double walk);

/// What is assumed of a span before it is seen: the frequency of the strongest oscillation in its first six
/// cycles with a deviation of 7 %, at rest give or take what the signal does there.
filters::Gaussian fresh_estimate(const Ringing& ringing, Eigen::Index first);

/// The median over spans of six cycles of what a damped sine leaves of each. @throws std::invalid_argument
/// when no span can be fitted.
double typical_noise(const Ringing& ringing);

struct Segments {
  double threshold = 0;
  Eigen::Index test_samples = 0;
  std::vector<Eigen::Index> begins;  ///< the first is 0
};

/// The sum of the last n normalised innovation squares, one cycle's, is chi-square of n degrees while the
/// model holds [willsky1976]. An alarm is a sum above the quantile whose excess probability is `false_alarms`
/// over the number of samples; the change is the first sample among those n that is improbable by itself
/// (1e-3). There the filter starts anew.
Segments find_segments(const Ringing& ringing, double walk, double false_alarms);

/// Force that would move the mode by the noise within six cycles: what changes are sought with.
double typical_force(const Ringing& ringing);

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
  std::string one_or_two;                       ///< a sentence where the span may have two modes in its place
  double amplitude_from = 0, amplitude_to = 0;  ///< of the mode at both ends [unit of the signal]
  double noise = 0;                             ///< standard deviation [unit of the signal]
  double noise_relative_deviation = 0;          ///< of that estimate; infinite where the record does not tell
  double walk = 0;                              ///< [1/sqrt(s)]
  double force = 0;                             ///< of unmeasured excitation [unit/s2 sqrt(s)]

  /// Whether more than noise rings: a span before a release has a frequency of its own, of the band's noise.
  bool rings() const {
    return amplitude_from > 2 * noise || amplitude_to > 2 * noise ||
           frequency_deviation_hz < 0.01 * frequency_hz;
  }
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
  std::string beat;  ///< a sentence where modes of constant frequency explain the whole record
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
