// Do the innovations look as the filter says they should?
#pragma once

#include <Eigen/Core>

#include "filters/filter_run.hpp"

namespace beamid::filters {

/// Tests of a run's innovations, all of which a consistent filter passes most of the time. Outputs that were
/// not measured do not count.
struct InnovationConsistency {
  double mean_normalised_square = 0;  ///< over the outputs: 1 when S has the right size
  double lower_95 = 0,
         upper_95 = 0;      ///< where 95 % of consistent runs of this length lie [barshalom2001, sec. 5.4]
  Eigen::VectorXd windows;  ///< the same mean over ten successive parts of the record
  double window_lower_95 = 0,
         window_upper_95 = 0;  ///< where all ten lie in 95 % of consistent runs (Bonferroni)
  /// Of successive whitened innovations of the first output; 0 when white.
  double lag_one_correlation = 0;
  double whiteness_p_value = 0;  ///< Ljung-Box test over 20 lags [ljung1978]; below 0.05: not white

  bool size_is_right() const {
    return mean_normalised_square >= lower_95 && mean_normalised_square <= upper_95;
  }
  bool size_is_steady() const {
    return windows.minCoeff() >= window_lower_95 && windows.maxCoeff() <= window_upper_95;
  }
  bool white() const { return whiteness_p_value >= 0.05; }
};

/// @throws std::invalid_argument when fewer than 100 samples were reached and told something.
InnovationConsistency innovation_consistency(const FilterRun& run);

}  // namespace beamid::filters
