#include "experiments/identify/joint_identification.hpp"

#include <cmath>
#include <stdexcept>

namespace beamid::experiments {
namespace {

using Eigen::Index;

constexpr Index first = 2, joint_unknowns = 2;  // K and C in [x, v, K, C, ...]

RecordEstimate estimate_of(const RecordIdentification& found) {
  const filters::Gaussian& last = found.identification.run.last;
  RecordEstimate estimate{{last.mean.segment(first, joint_unknowns), last.marginal(first, joint_unknowns)},
                          found.settings.initial.marginal(first, joint_unknowns)};
  // R counts, unless the record shows more noise at the mode
  if (found.interval_factor == 1.0) return estimate;
  estimate.noise_ratio = found.noise_ratio();
  estimate.noise_freedom = found.near_mode.freedom;
  return estimate;
}

}  // namespace

bool IdentifiedRecord::lost() const {
  return found.judgement.verdict == ComparedRun::Status::diverged;
}

JointIdentification joint_identification(std::vector<IdentifiedRecord> records) {
  JointIdentification joint{std::move(records), {}, {}};
  std::vector<RecordEstimate> estimates;
  const IdentifiedRecord* kept = nullptr;
  for (const IdentifiedRecord& one : joint.records) {
    if (one.lost()) continue;
    if (!kept) kept = &one;
    if (std::abs(one.found.model.equivalent_mass / kept->found.model.equivalent_mass - 1.0) > 1e-9)
      throw std::invalid_argument("joint identification: the records' beams have different masses");
    estimates.push_back(estimate_of(one.found));
  }
  if (!kept) return joint;
  joint.estimate = joint_estimate(estimates);
  filters::Gaussian estimate = kept->found.identification.run.last;
  estimate.mean.segment(first, joint_unknowns) = joint.estimate.unknowns.mean;
  estimate.covariance = Eigen::MatrixXd::Zero(estimate.mean.size(), estimate.mean.size());
  estimate.covariance.block(first, first, joint_unknowns, joint_unknowns) =
      joint.estimate.unknowns.covariance;
  joint.identification = identification_at(kept->found.model, estimate);
  return joint;
}

}  // namespace beamid::experiments
