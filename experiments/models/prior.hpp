// What is known of one degree of freedom before the record is seen.
#pragma once

#include <optional>

namespace beamid::experiments {

/// Means and standard deviations; absent ones are worked out from the model and the record.
struct Prior {
  std::optional<double> stiffness, stiffness_deviation;  ///< [N/m]
  std::optional<double> damping_ratio, damping_ratio_deviation;

  bool states_stiffness() const { return stiffness || stiffness_deviation; }
  bool states_damping() const { return damping_ratio || damping_ratio_deviation; }
};

}  // namespace beamid::experiments
