// A whole record through a filter.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "filters/filter.hpp"

namespace beamid::filters {

/// Where and why a filter stopped. A research result: the run up to there is kept.
struct Failure {
  Eigen::Index step = 0;  ///< index of the sample
  double time = 0.0;      ///< of that sample [s]
  std::string reason;
  double smallest_eigenvalue = 0.0;  ///< of the covariance that failed; NaN when none did
};

/// N samples to filter; a row per channel.
struct Measurements {
  Eigen::VectorXd time;     ///< (N) [s]
  Eigen::MatrixXd outputs;  ///< y (p x N)
  Eigen::MatrixXd inputs;   ///< u (m x N); empty: no input
};

/// x(t|t-1) and x(t|t) for every sample t that was reached, and what each said.
struct FilterRun {
  std::vector<Gaussian> predicted;       ///< before each sample; empty unless kept
  std::vector<Gaussian> filtered;        ///< after each sample; empty unless kept
  Eigen::MatrixXd innovations;           ///< (p x N)
  Eigen::MatrixXd whitened_innovations;  ///< L^-1 innovation, S = L L^T (p x N)
  Eigen::VectorXd normalised_squares;    ///< innovation^T S^-1 innovation (N)
  double log_likelihood = 0.0;
  Eigen::MatrixXd means;       ///< filtered, of the traced entries (k x N)
  Eigen::MatrixXd deviations;  ///< their standard deviations (k x N)
  Gaussian last;               ///< the last filtered belief
  std::optional<Failure> failure;
  std::vector<std::string> remarks;  ///< of the filter: approximations made, and what they cost
};

enum class Keep { last_belief, all_beliefs };

/// Entries of the state (k) whose filtered mean and deviation are recorded at every sample. For states of
/// thousands of entries, of which all beliefs would fill the memory.
struct Trace {
  std::vector<Eigen::Index> entries;
};

/// Whether the initial belief is about the first sample, or about one interval before it.
enum class Start { at_first_sample, one_interval_before };

/// Runs the filter over the record. Where it fails, what was not reached remains zero.
/// @throws std::invalid_argument when shapes disagree or a traced entry does not exist; numerical trouble of
/// the filter or of its discretisation ends the run and is told in `failure`.
FilterRun run(Filter& filter, const Gaussian& initial, const Measurements& measurements,
              Keep keep = Keep::last_belief, Start start = Start::at_first_sample, const Trace& trace = {});

}  // namespace beamid::filters
