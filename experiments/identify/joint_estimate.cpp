#include "experiments/identify/joint_estimate.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <stdexcept>

#include "experiments/identify/noise_near_mode.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

std::vector<Index> asked_of(const RecordEstimate& record) {
  std::vector<Index> asked;
  for (Index i = 0; i < record.unknowns.mean.size(); ++i)
    if (record.nuisance.empty() || !record.nuisance[static_cast<std::size_t>(i)]) asked.push_back(i);
  return asked;
}

/// What is known beforehand of nuisance unknowns (q x q), zero elsewhere.
MatrixXd prior_of_nuisance(const RecordEstimate& record) {
  MatrixXd information = record.prior.inverse();
  for (const Index i : asked_of(record)) information.row(i).setZero(), information.col(i).setZero();
  return information;
}

/// Whether the records agree, and by how much they scatter where they do not.
void judge_joint_estimate(const std::vector<RecordEstimate>& records,
                          const std::vector<MatrixXd>& information, JointEstimate& joint) {
  constexpr double disagree_below = 0.05;
  const std::vector<Index> asked = asked_of(records[0]);
  const double others = static_cast<double>(records.size()) - 1;
  VectorXd spread = VectorXd::Zero(joint.unknowns.mean.size());
  double noise_freedom = 0;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const MatrixXd covariance = (information[r] + prior_of_nuisance(records[r])).inverse();
    const VectorXd off = records[r].unknowns.mean - joint.unknowns.mean;
    const MatrixXd of_asked = covariance(asked, asked);
    joint.chi_squared += off(asked).dot(of_asked.inverse() * VectorXd(off(asked)));
    spread += off.cwiseAbs2().cwiseQuotient(covariance.diagonal());
    noise_freedom += records[r].noise_freedom;
  }
  joint.freedom = static_cast<double>(asked.size()) * others;
  if (!(joint.freedom > 0)) return;
  const boost::math::fisher_f distribution(joint.freedom, noise_freedom);
  joint.probability = cdf(complement(distribution, joint.chi_squared / joint.freedom));
  if (joint.probability < disagree_below)
    for (const Index i : asked) joint.scatter[i] = std::sqrt(std::max(1.0, spread[i] / others));
}

}  // namespace

JointEstimate joint_estimate(const std::vector<RecordEstimate>& records) {
  if (records.empty()) throw std::invalid_argument("joint estimate: no record; expected one at least");
  const Index q = records[0].unknowns.mean.size();
  const MatrixXd nuisance = prior_of_nuisance(records[0]);
  std::vector<MatrixXd> information;
  MatrixXd sum = MatrixXd::Zero(q, q);
  VectorXd weighted = VectorXd::Zero(q);
  if (records[0].start.size() > 0) weighted = nuisance * records[0].start;
  for (const RecordEstimate& record : records) {
    const double weight = 1 / (record.noise_ratio * record.noise_ratio);
    information.push_back(weight * (record.unknowns.covariance.inverse() - record.prior.inverse()));
    sum += information.back();
    weighted += information.back() * record.unknowns.mean;
    if (record.start.size() > 0) weighted += weight * nuisance * (record.unknowns.mean - record.start);
  }
  // scaled by what is known beforehand, units do not matter
  const VectorXd scale = records[0].prior.diagonal().cwiseSqrt();
  const Eigen::LLT<MatrixXd> factor(scale.asDiagonal() * (sum + nuisance) * scale.asDiagonal());
  if (factor.info() != Eigen::Success)
    throw std::invalid_argument("joint estimate: the records say nothing of a combination of the unknowns");
  JointEstimate joint;
  joint.scatter = VectorXd::Ones(q);
  joint.unknowns.mean = scale.cwiseProduct(factor.solve(scale.cwiseProduct(weighted)));
  joint.unknowns.covariance = (records[0].prior.inverse() + sum).inverse();
  judge_joint_estimate(records, information, joint);

  VectorXd uncertainty = VectorXd::Zero(q);  // 1 / Welch's degrees of freedom
  for (std::size_t r = 0; r < records.size(); ++r)
    uncertainty +=
        (joint.unknowns.covariance * information[r]).diagonal().cwiseAbs2() / records[r].noise_freedom;
  constexpr double least = 1e-9;  // a noise that is known
  VectorXd widen(q);
  for (Index i = 0; i < q; ++i)
    widen[i] = joint.scatter[i] * student_factor(1 / std::max(least, uncertainty[i]));
  joint.unknowns.covariance = widen.asDiagonal() * joint.unknowns.covariance * widen.asDiagonal();
  return joint;
}

}  // namespace beamid::experiments
