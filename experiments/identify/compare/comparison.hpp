// One record, identified in every chosen way.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/modal/dominant_mode.hpp"
#include "experiments/models/divergence.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/text/progress.hpp"
#include "filters/diagnostics.hpp"

namespace beamid::experiments {

/// What is identified, and what is known of it.
struct ComparedRecord {
  std::string name;                 ///< of the file, or of what it was simulated from
  Record record;                    ///< outputs and measured forces; channels know their places
  Eigen::VectorXd sensor_noise;     ///< standard deviation of every channel where it is known, else 0 (p)
  std::optional<Experiment> truth;  ///< the beam it was simulated from
  std::vector<std::string> notes;   ///< of the simulation
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> filled =
      {};  ///< samples that were missing: no readings to a filter; empty: none
};

/// Stamps made even and missing samples filled in, as finding a start and a modal analysis need it.
ComparedRecord measured_record(std::string name, const Record& record);

/// Simulated from the beam of `truth`, as `beamid simulate` does. @throws as simulate().
ComparedRecord simulated_record(const Experiment& truth, const std::filesystem::path& folder,
                                const Progress& progress);

/// What one unknown came out as.
struct ComparedParameter {
  Estimate estimate;
  std::optional<double> truth;  ///< [unit of the estimate]
  std::optional<double> bound;  ///< Cramer-Rao bound on its deviation [unit]; absent: not determined

  std::optional<double> error_percent() const;
  std::optional<double> bound_ratio() const;  ///< deviation / bound
};

/// One reduction, filter and discretisation.
struct ComparedRun {
  enum class Status {
    converged,
    diverged,  ///< the filter failed, or its motion is not the record's
    refused    ///< the model cannot be made this way
  };
  std::string reduction, filter, discretisation;  ///< with the options that were chosen
  Status status = Status::converged;
  std::string reason;               ///< where it did not converge
  std::string step_cause;           ///< what the discretisation alone does to the mode; empty: nothing much
  Eigen::Index coordinates = 0;     ///< r, of the model
  double observed_per_freedom = 0;  ///< p / r, the paper's O/F ratio
  std::vector<ComparedParameter> parameters;
  double response_error_percent = 0.0;
  Eigen::VectorXd noise;       ///< standard deviation assumed in the last pass (p)
  Eigen::VectorXd noise_left;  ///< root mean square of what the best motion leaves of the readings (p)
  std::optional<double> frequency_hz;  ///< of the model's first mode at the estimate
  std::optional<FoundMode> mode;       ///< likewise, where its equations tell it
  double noise_ratio = 1;         ///< deviation of the noise that counts over that assumed (run_verdict.hpp)
  double noise_freedom = 1e9;     ///< degrees of freedom that this ratio is known with
  double seconds = 0.0;           ///< all passes of the filter
  double response_seconds = 0.0;  ///< the reproduction and the bound
  Eigen::MatrixXd reproduced;     ///< (p x N)
  filters::FilterRun run;
  std::vector<Unknown> unknowns;                    ///< of the model, in the order of the parameters (q)
  filters::Gaussian unknown_state, unknown_start;   ///< of what the filter's state carries for them: at the
                                                    ///< end, and at the start of the last pass (q)
  std::optional<filters::Diagnostics> diagnostics;  ///< of the last pass; absent below 100 samples
  std::vector<std::string> remarks;
};

struct Comparison {
  ComparedRecord compared;
  std::vector<ComparedRun> runs;
  std::optional<ModalEstimate> modal = {};  ///< of the first output, near the beam's mode; absent: none found
  std::vector<std::string> warnings = {};   ///< for the first lines of a report
};

const char* to_string(ComparedRun::Status status);

/// Every reduction x filter x discretisation of the experiment on the record.
///
/// Each model gets a first guess (first_guess.hpp), and from it the motion nearest to the record
/// (reproduction.hpp), about which the first pass of every filter is linearised; further passes likewise from
/// what the one before found. The noise of a channel is [noise] where given, else what that motion leaves of
/// the record, never less than the sensor's own: what a reduced model cannot follow is noise to it.
/// @param folder in which the files of given shapes are looked for.
/// @throws InputError, std::invalid_argument when no run can be made of the experiment at all.
Comparison compare(const Experiment& experiment, ComparedRecord record, const std::filesystem::path& folder,
                   const Progress& progress);

}  // namespace beamid::experiments
