#include "experiments/identify/engine/joint_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/Dense>
#include <boost/math/distributions/fisher_f.hpp>

#include "experiments/identify/verdict/noise_near_mode.hpp"

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
    throw std::invalid_argument("joint estimate: the records do not determine a combination of the unknowns");
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

std::string agreement_words(const JointEstimate& estimate, const std::vector<std::string>& names) {
  if (estimate.freedom == 0) return "One record remains: no other to agree with.";
  const std::string measured =
      fmt::format("chi-squared {:.3g} about the joint estimate, {:g} degrees of freedom, probability {:.2g}",
                  estimate.chi_squared, estimate.freedom, estimate.probability);
  if (estimate.agree())
    return fmt::format("The records agree within their noise ({}): their information adds up.", measured);
  std::string widened;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const double ratio = estimate.scatter[static_cast<Eigen::Index>(i)]; ratio > 1)
      widened += fmt::format("{}{} by {:.3g}", widened.empty() ? "" : ", ", names[i], ratio);
  return fmt::format(
      "THE RECORDS DISAGREE by more than their noise ({}). No constant parameters describe all of them. "
      "Possible causes: damping or frequency that depends on amplitude, a clamp that moved, or motion that "
      "the model lacks. The joint intervals include the scatter of the records (Birge's ratio: {}), which "
      "few records determine poorly.",
      measured, widened);
}

nlohmann::ordered_json agreement_values(const JointEstimate& estimate,
                                        const std::vector<std::string>& names) {
  nlohmann::ordered_json json{{"chi_squared", estimate.chi_squared},
                              {"degrees_of_freedom", estimate.freedom},
                              {"probability", estimate.probability},
                              {"agree", estimate.agree()}};
  for (std::size_t i = 0; i < names.size(); ++i)
    json["scatter"][names[i]] = estimate.scatter[static_cast<Eigen::Index>(i)];
  return json;
}

namespace {

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

namespace {

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
    if (!run.answers()) continue;
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
