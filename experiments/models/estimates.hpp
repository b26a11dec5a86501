// What a filter's last estimate says about the unknowns, in physical units.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/models/identification.hpp"
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

// Whether a filter has lost the motion, and by which condition: one test for every command.

/// The lowest mode of a model at its estimate.
struct FoundMode {
  double frequency_hz = 0.0;             ///< undamped; not positive or NaN: nothing oscillates
  double damping_ratio = 0.0;            ///< negative: the motion grows
  double damping_ratio_deviation = 0.0;  ///< standard deviation of the ratio; 0: not known
  double frequency_deviation_hz = 0.0;   ///< likewise
};

/// Largest relative distance of a found frequency from that of the record.
inline constexpr double same_motion = 0.05;

/// The condition that a found mode violates, for "diverged: ..."; empty where it violates none. In this
/// order: nothing oscillates; its damping ratio is negative by more than its 95 % interval; its frequency is
/// more than 5 % from the record's.
/// @param record_hz by a modal analysis, which knows no model [Hz]; absent: there is none to compare with.
std::string divergence(const FoundMode& found, std::optional<double> record_hz);

/// The same of one degree of freedom; a filter that failed comes first, with sample, time and reason.
std::string divergence(const Identification& result, std::optional<double> record_hz);

/// "sample 12, 0.0120 s: the covariance lost its ... (smallest eigenvalue -1e-9)"
std::string failure_text(const filters::Failure& failure);

/// Where the discretisation alone takes a mode, in a record without any error, beyond the test above or moves
/// its damping ratio by as much as that is (by 0.1 % at least), sentences with what it makes of it; empty
/// where it does not, and for the exact scheme.
/// @param mode as a modal analysis, or the exact scheme, finds it; @param interval of the filter [s]
/// @throws std::invalid_argument on an unknown scheme.
std::string step_too_long(const std::string& scheme, const FoundMode& mode, double interval);

}  // namespace beamid::experiments
