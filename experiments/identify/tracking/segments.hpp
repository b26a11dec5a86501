// Where the motion changes: the filter started anew wherever its innovations say so.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <utility>
#include <vector>

#include "filters/noise_estimation.hpp"

namespace beamid::experiments {

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

/// An extended Kalman filter on the ringing model.
std::unique_ptr<filters::Filter> ringing_filter(const Ringing& ringing, const filters::Noise& noise);

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

}  // namespace beamid::experiments
