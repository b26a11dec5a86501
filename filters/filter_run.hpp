// A whole record through a filter.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "filters/filter.hpp"
#include "filters/measurements.hpp"
#include "filters/running_filter.hpp"

namespace beamid::filters {

/// x(t|t-1) and x(t|t) for every sample t that was reached, and what each said; NaN where an output was not
/// measured or could not be taken in.
struct FilterRun {
  std::vector<Gaussian> predicted;       ///< before each sample; empty unless kept
  std::vector<Gaussian> filtered;        ///< after each sample; empty unless kept
  Eigen::MatrixXd innovations;           ///< (p x N)
  Eigen::MatrixXd whitened_innovations;  ///< L^-1 innovation, S = L L^T (p x N)
  Eigen::VectorXd normalised_squares;    ///< innovation^T S^-1 innovation (N)
  double log_likelihood = 0.0;
  Eigen::MatrixXd means;       ///< filtered, of the traced entries (k x N)
  Eigen::MatrixXd deviations;  ///< their standard deviations (k x N)
  Gaussian last;               ///< the last filtered estimate
  std::optional<Failure>
      failure;  ///< what ended the run; the part up to there is a research result, and kept
  std::vector<Failure> events = {};  ///< all that went wrong, that included: what was inflated, what diverged
  std::vector<std::string> remarks;  ///< of the filter: approximations made, and what they cost
};

enum class Keep { last_estimate, all_estimates };

/// Entries of the state (k) whose filtered mean and deviation are recorded at every sample. For states of
/// thousands of entries, of which all estimates would fill the memory.
struct Trace {
  std::vector<Eigen::Index> entries;
};

/// What a run keeps, where it starts and how it goes on after a failure.
struct RunSettings {
  Keep keep = Keep::last_estimate;
  Start start = Start::at_first_sample;
  Trace trace = {};
  OnFailure on_failure = OnFailure::stop;
};

/// Runs the filter over the record, by RunningFilter. Where it fails, what was not reached remains zero.
/// @throws std::invalid_argument when shapes disagree, stamps do not increase, the model cannot move by the
/// intervals between them, or a traced entry does not exist; numerical trouble of the filter or of its
/// discretisation is told in `failure` and `events`.
FilterRun run(Filter& filter, const Gaussian& initial, const Measurements& measurements,
              const RunSettings& settings);
FilterRun run(Filter& filter, const Gaussian& initial, const Measurements& measurements,
              Keep keep = Keep::last_estimate, Start start = Start::at_first_sample, const Trace& trace = {});

}  // namespace beamid::filters
