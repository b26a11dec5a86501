// A record in which one slow mode is left, and the noise near it.
#pragma once

#include <Eigen/Core>

#include "filters/measurements.hpp"

namespace beamid::experiments {

/// Low-passed and decimated (signal/decimation.hpp) to about eight samples per period.
struct SlowRecord {
  Eigen::VectorXd time;        ///< (M) [s]
  Eigen::MatrixXd samples;     ///< (p x M)
  double interval = 0.0;       ///< between them [s]
  int factor = 1;              ///< of the decimation
  int steps = 1;               ///< of the motion between two samples
  filters::Measurements fine;  ///< the same at every step, outputs NaN where there is no sample

  /// Columns of the samples among those of all steps (p x M).
  Eigen::MatrixXd measured(const Eigen::MatrixXd& fine_columns) const;
};

/// @param inputs of the record, m; @param frequency_hz of the mode
SlowRecord slow_record(const filters::Measurements& record, Eigen::Index inputs, double frequency_hz);

/// Deviation of white noise as dense as what is left of a record near a frequency, between half and one and a
/// half times it, or as all of it where that is more (p).
/// @param left (p x M); @param fitted numbers of unknowns that took their part of it away
Eigen::VectorXd noise_near(const Eigen::MatrixXd& left, double interval, double frequency_hz, double fitted);

}  // namespace beamid::experiments
