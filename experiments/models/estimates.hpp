// What a filter's last estimate says about the unknowns, in physical units.
#pragma once

#include <string>
#include <vector>

#include "experiments/models/joint_model.hpp"
#include "filters/gaussian.hpp"

namespace beamid::experiments {

/// One unknown after the record. The interval is that of the filter's state carried through the unknown's
/// form, so that a logarithmic or bounded one never leaves what is possible.
struct Estimate {
  std::string name, unit;
  double value = 0.0, deviation = 0.0;              ///< [unit]
  double lower_95 = 0.0, upper_95 = 0.0;            ///< [unit]
  double prior_value = 0.0, prior_deviation = 0.0;  ///< before the record [unit]
  bool nuisance = false;
};

/// One for each unknown, in the model's order.
std::vector<Estimate> estimates(const JointModel& model, const filters::Gaussian& estimate);

/// Mean of the estimate about the unknowns, in physical units (q).
Eigen::VectorXd unknown_values(const JointModel& model, const Eigen::VectorXd& state);

/// Normal quantile of 97.5 %.
inline constexpr double quantile_95 = 1.959963984540054;

}  // namespace beamid::experiments
