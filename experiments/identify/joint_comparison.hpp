// The unknowns of any model from several records of one structure.
#pragma once

#include "experiments/identify/compare/comparison.hpp"
#include "experiments/identify/joint_estimate.hpp"

namespace beamid::experiments {

/// What a run says of the unknowns; the noise near its mode counts.
RecordEstimate record_estimate(const ComparedRun& run);

/// What all records say together. Each was identified by itself, in one way: own start, noise and window.
struct JointComparison {
  std::vector<Comparison> records;  ///< of one run each
  JointEstimate estimate;  ///< of what the filter's state carries, by the runs that converged; empty: none
  std::vector<Estimate> parameters;  ///< at it (q)

  bool none_converged() const { return parameters.empty(); }
};

/// Deviations count the noise near each record's mode where its runs were judged (run_verdict.hpp).
/// @throws std::invalid_argument when the records' models have different unknowns.
JointComparison joint_comparison(std::vector<Comparison> records);

}  // namespace beamid::experiments
