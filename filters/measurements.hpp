// A record as a filter takes it in.
#pragma once

#include <Eigen/Core>

namespace beamid::filters {

/// N samples; a row per channel.
///
/// Stamps may be irregular. Outputs that are NaN were not measured: gaps of a channel, or channels of
/// different rates on the stamps of all of them.
struct Measurements {
  Eigen::VectorXd time;     ///< increasing (N) [s]
  Eigen::MatrixXd outputs;  ///< y (p x N)
  Eigen::MatrixXd inputs;   ///< how m inputs run to the next stamp: InputPaths (m (d + 1) x N); empty: none
  Eigen::MatrixXd output_deviations =
      {};                        ///< of the noise: R_k = diag(squares) (p x N); empty: the model's R
  double time_resolution = 0.0;  ///< stamps are exact to within this [s]; see SampleClock

  Eigen::Index size() const { return time.size(); }  ///< N

  /// Mean sampling interval [s].
  double interval() const { return (time[size() - 1] - time[0]) / static_cast<double>(size() - 1); }
};

/// @throws std::invalid_argument when shapes disagree with each other or with p outputs, stamps are not
/// finite or do not increase, or the deviation of an output that was measured is not finite and at least 0.
void check_measurements(const Measurements& measurements, Eigen::Index outputs);

/// R_k of one step: diag(deviations^2) (p x p); those that are not finite count as 0, as nothing was
/// measured.
Eigen::MatrixXd step_noise(const Eigen::VectorXd& deviations);

}  // namespace beamid::filters
