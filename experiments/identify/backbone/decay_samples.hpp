// The samples of a free decay as output-error fits take them.
#pragma once

#include "experiments/record/record.hpp"
#include "filters/batch_estimator.hpp"

namespace beamid::experiments {

/// Samples as they are, and at the fine steps that the registered models take, NaN between.
struct DecaySamples {
  filters::Measurements plain, fine;
  double lost = 0;       ///< before the first of them [s]
  double whiteness = 1;  ///< what the low-pass takes from the variance of white noise
  int steps = 1;         ///< fine steps between two samples
  int factor = 1;        ///< of the decimation
  double frequency_hz = 0;
  Quantity quantity = Quantity::acceleration;

  double interval() const { return plain.time[1] - plain.time[0]; }
  Eigen::Index size() const { return plain.time.size(); }
  double peak() const { return plain.outputs.cwiseAbs().maxCoeff(); }

  /// Settings of an estimate from samples with `steps` steps between them.
  /// @param grow whether to begin with the first cycles
  /// @param most passes for each length
  filters::BatchSettings batch_settings(int steps, bool grow, int most) const;
};

/// Of a signal (N), low-passed to `samples_per_period` of the frequency where it has four times as many; 48
/// fine steps in a period at least.
DecaySamples decay_samples(const Eigen::VectorXd& signal, double interval, Quantity quantity,
                           double frequency_hz, double samples_per_period);

}  // namespace beamid::experiments
