// One record, identified in every chosen way.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/clocks/likeliest_clock.hpp"
#include "experiments/identify/driven/description_faults.hpp"
#include "experiments/identify/driven/driven_fit.hpp"
#include "experiments/identify/engine/analysis.hpp"
#include "experiments/identify/engine/noise_in_estimates.hpp"
#include "experiments/modal/channel_fault.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/text/objection.hpp"
#include "experiments/text/progress.hpp"
#include "filters/batch_estimator.hpp"
#include "filters/diagnostics.hpp"

namespace beamid::experiments {

// The yardstick: all samples at once, by the model that the filter has.

/// What all samples at once show.
struct BatchIdentification {
  filters::BatchEstimate estimate;
  std::vector<Estimate> parameters;              ///< empty unless the record determines all
  std::optional<Identification> identification;  ///< of one degree of freedom, without a run; likewise
};

/// Output-error maximum likelihood (filters::estimate_batch) of initial motion, unknowns and offsets, without
/// a prior. Its noise and its discretisation are the filter's.
/// @param start of the motion nearest to the record, with the unknowns that the filter started from (n)
/// @param directions in which it is free (n x r)
BatchIdentification identify_batch(const JointModel& model, const IdentificationSettings& settings,
                                   const Eigen::VectorXd& start, const Eigen::MatrixXd& directions,
                                   const filters::Measurements& measured);

struct RecordIdentification;

/// What is identified, and what is known of it.
struct ComparedRecord {
  std::string name;                 ///< of the file, or of what it was simulated from
  Record record;                    ///< outputs and measured forces; channels know their places
  Eigen::VectorXd sensor_noise;     ///< standard deviation of every channel where it is known, else 0 (p)
  std::optional<Experiment> truth;  ///< the beam it was simulated from
  std::vector<std::string> notes;   ///< of the simulation
  /// Noise of the channels of motion, from before an event (p): noise_before_event(); needed where the
  /// experiment wants it.
  Eigen::VectorXd quiet_noise = {};
  std::vector<OwnClock> clocks = {};  ///< of channels that have one of their own, with their lags
  bool clocks_are_aligned = false;    ///< else such a channel is not looked at yet

  bool has_open_clocks() const { return !clocks.empty() && !clocks_are_aligned; }
};

/// A record of a file.
ComparedRecord measured_record(std::string name, const Record& record);

/// Simulated from the beam of `truth`, as `beamid simulate` does. @throws as simulate().
ComparedRecord simulated_record(const Experiment& truth, const std::filesystem::path& folder,
                                const Progress& progress);

/// Poles and shapes of their own, fitted to a free decay, beside the motion of a model with the same modes.
struct FreeModes {
  double chi_square = 0.0,
         freedom = 0.0;    ///< of what they explain beyond the model, in the noise near the modes
  double share = 0.0;      ///< root mean square of that over that of the record
  double left = 0.0;       ///< likewise, the residual of the free modes
  std::string difference;  ///< the mode or the channel in which both differ most

  /// Whether the difference is no noise: p < 1e-4, and more than a thousandth of the record.
  bool exclude() const;
  /// By which deviations grow, as if all of it were one parameter's: what one wrong length or mass makes is
  /// no scatter, and may lie in the direction of one parameter. 1 where nothing is excluded, or known.
  double widening() const;
};

/// What one unknown came out as.
struct ComparedParameter {
  Estimate estimate;
  std::optional<double> truth;  ///< [unit of the estimate]
  std::optional<double> bound;  ///< Cramer-Rao bound on its deviation [unit]; absent: not determined
  /// The filter's deviation over the least that record and prior allow, where it was clearly below and is
  /// widened to that; else 1.
  double overconfidence = 1.0;

  std::optional<double> error_percent() const;
  std::optional<double> bound_ratio() const;  ///< deviation / bound
};

/// One reduction, filter and discretisation.
struct ComparedRun {
  enum class Status {
    converged,
    approximate,   ///< the model explains most of a driven record's motion, the rest is not noise; intervals
                   ///< hold the scatter over its sections
    contradicted,  ///< the modal analysis of the same record has less than half or more than twice the
                   ///< damping; or the motion that the measured input makes of the model is not the record's;
                   ///< or the last pass still moved an unknown by many of its deviations; or the filter
                   ///< is more than twice as sure of one as the record allows
    not_unique,    ///< other sets of parameters explain the record as well, and nothing decides between them
    diverged,      ///< the filter failed, or its motion is not the record's
    refused        ///< the model cannot be made this way
  };
  std::string reduction, filter, discretisation;  ///< with the options that were chosen
  Status status = Status::converged;
  std::string reason;               ///< where it did not converge
  Place refused_at = {};            ///< what of the experiment file is at fault; empty: not known
  std::string step_cause;           ///< what the discretisation alone does to the mode; empty: nothing much
  Eigen::Index coordinates = 0;     ///< r, of the model
  double observed_per_freedom = 0;  ///< p / r, the paper's O/F ratio
  std::vector<ComparedParameter> parameters;
  double response_error_percent = 0.0;
  double misfit_percent = 0.0;        ///< of it what noise does not explain (reproduction.hpp)
  Eigen::VectorXd noise;              ///< standard deviation assumed in the last pass (p)
  Eigen::VectorXd noise_left;         ///< root mean square of what the best motion leaves of the readings (p)
  std::vector<bool> noise_is_stated;  ///< in the experiment file, rather than taken from the record (p)
  Eigen::VectorXd noise_relative_deviation;  ///< standard errors of it (p); empty: not known
  std::optional<double> frequency_hz;        ///< of the model's first mode at the estimate
  std::optional<FoundMode> mode;             ///< likewise, where its equations tell it
  std::optional<NoiseNearMode> near_mode;    ///< of the first output, at the record's mode
  std::vector<NoiseInEstimate> noise_in;  ///< how much of it reaches each unknown (q); empty: by `near_mode`
  double last_move = 0.0;                 ///< of an unknown by the last pass, in its standard deviations
  double interval_factor = 1;             ///< of deviations, the largest: what counts is not R; 1 at least
  double noise_ratio = 1;                 ///< deviation of the noise that counts over that assumed
  double noise_freedom = 1e9;             ///< degrees of freedom that this ratio is known with
  double seconds = 0.0;                   ///< all passes of the filter
  double response_seconds = 0.0;          ///< the reproduction and the bound
  Eigen::MatrixXd reproduced;             ///< (p x N)
  std::shared_ptr<JointModel> model;      ///< on the basis of the last pass; absent where it was refused
  IdentificationSettings settings;        ///< of the last pass
  filters::FilterRun run;
  std::vector<Unknown> unknowns;                   ///< of the model, in the order of the parameters (q)
  filters::Gaussian unknown_state, unknown_start;  ///< of what the filter's state carries for them: at the
                                                   ///< end, and at the start of the last pass (q)
  std::optional<SectionScatter> sections;          ///< of a driven record that is long enough
  DescriptionTests description;                    ///< of a driven linear model; by `identify`
  std::optional<ClockStep> clocks;      ///< of channels with clocks of their own; absent: there are none
  LikeliestClocks likeliest_clocks;     ///< of a driven record without such channels
  std::optional<FreeModes> free_modes;  ///< of a free decay; by `identify`
  std::optional<ClockScatter> clock_scatter;  ///< of a free decay's channels that do not agree; by `identify`
  std::optional<LikeliestInputNoise> likeliest_input_noise;  ///< likewise, of exact inputs; by `identify`
  std::optional<filters::Diagnostics> diagnostics;           ///< of the last pass; absent below 100 samples
  std::vector<filters::Gaussian> smoothed;   ///< of every sample, where a smoother was asked for
  std::optional<BatchIdentification> batch;  ///< where it was asked for
  std::vector<std::string> remarks;
  std::vector<Objection> objections;  ///< for the first lines of a report, the worst first
  std::shared_ptr<const RecordIdentification> oscillator;  ///< K and C of a free decay, judged; else absent

  /// The worst first: before those that are there.
  void object(Objection worse) { objections.insert(objections.begin(), std::move(worse)); }

  /// No single estimate is to be relied on, for this reason.
  void contradict(const std::string& why, Objection worst) {
    status = Status::contradicted;
    reason = why;
    object(std::move(worst));
  }

  /// Whether the estimates and their intervals may be relied on.
  bool answers() const { return status == Status::converged || status == Status::approximate; }
  bool has_estimate() const {
    return answers() || status == Status::contradicted || status == Status::not_unique;
  }
};

/// One record in every way it was identified.
struct Comparison {
  ComparedRecord compared;
  RecordAnalysis analysis;
  std::vector<ComparedRun> runs;
  std::vector<Objection> objections = {};  ///< to the record, for the first lines of a report
};

const char* to_string(ComparedRun::Status status);

/// Of the parameters of a run, in their units: the correlations of what the filter carries with the
/// deviations that are reported (q x q); empty where there is no estimate.
Eigen::MatrixXd covariance_of_parameters(const ComparedRun& run);

/// Every reduction x filter x discretisation of the experiment on the record: the one engine, whatever model
/// is asked.
///
/// The record is analysed once (analysis.hpp). Each model gets a first guess (first_guess.hpp, or the modal
/// analysis for one degree of freedom), and from it the motion nearest to the record (reproduction.hpp),
/// about which the first pass of every filter is linearised; further passes likewise from what the one before
/// found. The noise of a channel is [noise] where given, else what that motion leaves of the record, never
/// less than the sensor's own: what a reduced model cannot follow is noise to it. Each run is judged beside
/// the modal analysis (run_verdict.hpp).
/// @param folder in which the files of given shapes are looked for.
/// @param keep estimates of every sample, for histories; a smoother asks for them anyway
/// @throws InputError, std::invalid_argument when no run can be made of the experiment at all.
Comparison compare(const Experiment& experiment, ComparedRecord record, const std::filesystem::path& folder,
                   const Progress& progress, filters::Keep keep = filters::Keep::last_estimate);

/// The experiment's own reduction, filter and discretisation: a comparison of one run, what was not measured
/// counted at every sample.
Comparison identify_with_model(Experiment experiment, ComparedRecord record,
                               const std::filesystem::path& folder, const Progress& progress);

// What some of a record's channels would have shown.

/// The record with these channels of motion only, in its own order; measured forces stay.
/// @throws std::invalid_argument when a name is no channel of motion, or several have it.
ComparedRecord chosen_channels(ComparedRecord compared, const std::vector<std::string>& names);

/// Likewise, of its channels those that are kept (one for each), with what is known of each.
ComparedRecord with_channels(ComparedRecord compared, const std::vector<bool>& kept);

}  // namespace beamid::experiments
