#include "experiments/identify/joint_comparison.hpp"

#include <cmath>
#include <stdexcept>

namespace beamid::experiments {
namespace {

using Eigen::Index;

bool same(const std::vector<Unknown>& a, const std::vector<Unknown>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t j = 0; j < a.size(); ++j)
    if (a[j].name != b[j].name || a[j].form != b[j].form) return false;
  return true;
}

}  // namespace

RecordEstimate record_estimate(const ComparedRun& run) {
  RecordEstimate estimate{run.unknown_state, run.unknown_start.covariance};
  estimate.start = run.unknown_start.mean;
  estimate.noise_ratio = run.noise_ratio;
  estimate.noise_freedom = run.noise_freedom;
  for (std::size_t j = 0; j < run.unknowns.size(); ++j) {
    estimate.nuisance.push_back(run.unknowns[j].nuisance);
    const auto place = static_cast<Index>(j);
    if (!run.unknowns[j].nuisance)
      estimate.start[place] = run.unknown_state.mean[place];  // the passes' fixed point
  }
  return estimate;
}

JointComparison joint_comparison(std::vector<Comparison> records) {
  JointComparison joint{std::move(records), {}, {}};
  std::vector<RecordEstimate> estimates;
  const ComparedRun* kept = nullptr;
  for (const Comparison& record : joint.records) {
    const ComparedRun& run = record.runs.at(0);
    if (!run.has_estimate()) continue;
    if (!kept) kept = &run;
    if (!same(run.unknowns, kept->unknowns))
      throw std::invalid_argument(
          "joint estimate: " + record.compared.name +
          " has other unknowns than the records before it; expected the same channels "
          "in all records");
    estimates.push_back(record_estimate(run));
  }
  if (!kept) return joint;
  joint.estimate = joint_estimate(estimates);
  const Eigen::VectorXd deviations = joint.estimate.unknowns.deviations();
  for (std::size_t j = 0; j < kept->unknowns.size(); ++j) {
    const Unknown& unknown = kept->unknowns[j];
    const double mean = joint.estimate.unknowns.mean[static_cast<Index>(j)],
                 deviation = deviations[static_cast<Index>(j)];
    joint.parameters.push_back({unknown.name, unknown.unit, unknown.to_physical(mean),
                                std::abs(unknown.slope(mean)) * deviation,
                                unknown.to_physical(mean - quantile_95 * deviation),
                                unknown.to_physical(mean + quantile_95 * deviation), unknown.guess,
                                unknown.deviation, unknown.nuisance});
  }
  return joint;
}

}  // namespace beamid::experiments
