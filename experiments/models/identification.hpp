// Stiffness and damping from a record, by a filter on a joint model.
#pragma once

#include <string>

#include "experiments/models/joint_model.hpp"
#include "experiments/models/oscillator.hpp"
#include "filters/filter_run.hpp"

namespace beamid::experiments {

/// How a record is identified.
struct IdentificationSettings {
  std::string filter = "ekf";
  filters::Options filter_options;
  std::string discretisation = "exponential";
  filters::Gaussian initial;                               ///< estimate about [x, v, K, C, ...]
  filters::Start start = filters::Start::at_first_sample;  ///< what instant that estimate is about
  Eigen::MatrixXd output_noise;                            ///< R
  /// Times the record is filtered; each pass starts from the parameters the one before ended with, and from
  /// the same initial covariance (next_start). Repeating removes what is left of the linearisation about a
  /// poor first guess.
  int passes = 1;
  filters::OnFailure on_failure = filters::OnFailure::stop;
  Eigen::MatrixXd process_noise = {};  ///< Q of the state per step; empty: none
  /// Standard deviations of the inputs' white noise (m); empty: they are exact (noisy_inputs.hpp).
  Eigen::VectorXd input_noise = {};
};

/// Whether any input's samples are uncertain.
bool has_noise(const Eigen::VectorXd& inputs);

/// The estimate that the next pass over the record starts from: `initial` with the constants that `last`
/// found but for the nuisance parameters, what is known of which must not be counted twice.
filters::Gaussian next_start(const JointModel& model, const filters::Gaussian& initial,
                             const filters::Gaussian& last);

/// The record through the filter, pass after pass; the run of the last one, or of the first that failed.
/// @param trace entries of the state whose history the last pass records, whatever else is kept
/// @throws std::invalid_argument when the settings do not fit the model or the record.
filters::FilterRun filter_record(const JointModel& model, const filters::Measurements& record,
                                 const IdentificationSettings& settings,
                                 filters::Keep keep = filters::Keep::last_estimate,
                                 const filters::Trace& trace = {});

/// What was found of one degree of freedom.
struct Identification {
  Oscillator found;                ///< K and C at the end of the record
  double stiffness_deviation = 0;  ///< standard deviations the filter reports
  double damping_deviation = 0;
  double frequency_deviation_hz = 0;
  double damping_ratio_deviation = 0;
  filters::FilterRun run;  ///< of the last pass
};

/// Whether a model asks about K and C of one degree of freedom alone, in the state [x, v, K, C, ...].
bool is_oscillator(const JointModel& model);

/// K, C and what follows from them, at an estimate about [x, v, K, C, ...]; without a run.
Identification identification_at(const JointModel& model, const filters::Gaussian& estimate);

/// K and C by model sdof. @throws std::invalid_argument when the settings do not fit the model or the record.
Identification identify(const JointModel& model, const filters::Measurements& record,
                        const IdentificationSettings& settings,
                        filters::Keep keep = filters::Keep::last_estimate);

/// Whether the filter lost the motion, without knowledge of the truth: whether divergence() has a reason.
/// @param modal_frequency_hz of a modal analysis [Hz]
bool lost(const Identification& result, double modal_frequency_hz);

}  // namespace beamid::experiments
