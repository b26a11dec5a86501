#include "experiments/identify/joint_identification.hpp"

#include <cmath>
#include <stdexcept>

namespace beamid::experiments {
namespace {

using Eigen::Index;

constexpr Index first = 2, joint_unknowns = 2;  // K and C in [x, v, K, C, ...]

RecordBelief belief_of(const RecordIdentification& found) {
  const filters::Gaussian& last = found.identification.run.last;
  RecordBelief belief{{last.mean.segment(first, joint_unknowns), last.marginal(first, joint_unknowns)},
                      found.settings.initial.marginal(first, joint_unknowns)};
  // R counts, unless the record shows more noise at the mode
  if (found.interval_factor == 1.0) return belief;
  belief.noise_ratio = found.noise_ratio();
  belief.noise_freedom = found.near_mode.freedom;
  return belief;
}

}  // namespace

bool IdentifiedRecord::lost() const {
  return found.judgement.verdict == ComparedRun::Status::diverged;
}

JointIdentification joint_identification(std::vector<IdentifiedRecord> records) {
  JointIdentification joint{std::move(records), {}, {}};
  std::vector<RecordBelief> beliefs;
  const IdentifiedRecord* kept = nullptr;
  for (const IdentifiedRecord& one : joint.records) {
    if (one.lost()) continue;
    if (!kept) kept = &one;
    if (std::abs(one.found.model.equivalent_mass / kept->found.model.equivalent_mass - 1.0) > 1e-9)
      throw std::invalid_argument("joint identification: the records' beams have different masses");
    beliefs.push_back(belief_of(one.found));
  }
  if (!kept) return joint;
  joint.estimate = joint_estimate(beliefs);
  filters::Gaussian belief = kept->found.identification.run.last;
  belief.mean.segment(first, joint_unknowns) = joint.estimate.unknowns.mean;
  belief.covariance = Eigen::MatrixXd::Zero(belief.mean.size(), belief.mean.size());
  belief.covariance.block(first, first, joint_unknowns, joint_unknowns) = joint.estimate.unknowns.covariance;
  joint.identification = identification_at(kept->found.model, belief);
  return joint;
}

}  // namespace beamid::experiments
