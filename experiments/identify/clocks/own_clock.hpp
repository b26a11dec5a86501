// Channels whose stamps are by another clock than the others'.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

/// One such channel. What it showed at t it stamped t + lag.
struct OwnClock {
  Eigen::Index channel = 0;           ///< of the record
  bool input = false;                 ///< a measured force or motion of the base
  std::vector<Eigen::Index> outputs;  ///< that depend on the lag: its own, or all of an input (of p)
  double lag = 0.0;                   ///< behind the others, as found [s]
  double deviation = 0.0;             ///< of the lag, unknown parameters and start allowed for [s]
};

/// Those that the record names.
/// @throws std::invalid_argument when it has no such channel, its stamps are not even, no channel of motion
/// keeps the common clock, or one of several inputs does not.
std::vector<OwnClock> own_clocks(const Record& record);

/// Every such channel earlier by its lag, NaN where it was not read; where an input was not, the record is
/// shorter.
/// @throws std::invalid_argument when fewer than 16 samples remain.
Record with_common_clock(const Record& as_read, const std::vector<OwnClock>& clocks);

/// How far `read` lags behind `made`, where their correlation over all rows, each of unit size, is largest;
/// up to a quarter of the record [s]. Missing samples (NaN) count as none.
///
/// Whitened wholly, every frequency counts alike, and resonances that the model has elsewhere cost nothing;
/// not at all, the resonances count, where noise counts least [knapp1976].
/// @param read (p x N), @param made (p x N) at an interval [s]
/// @param whitened w of a cross spectrum over its magnitude to the power w, 0 to 1
double lag_by_correlation(const Eigen::MatrixXd& read, const Eigen::MatrixXd& made, double interval,
                          double whitened);

}  // namespace beamid::experiments
