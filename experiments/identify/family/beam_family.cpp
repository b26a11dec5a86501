#include "experiments/identify/family/beam_family.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/Dense>
#include <boost/math/distributions/chi_squared.hpp>

#include "experiments/identify/engine/joint_comparison.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double weak_prior = 1e-4;      // of its information
constexpr double disagree_below = 0.05;  // probability
constexpr double determined = 1.0;       // by the record: an eigenvalue of P0^1/2 I_r P0^1/2 above this

struct EstimatePart {
  std::vector<Index> places;  // in the union
  MatrixXd information;       // I_r
};

// Positive semidefinite: rounding of the difference taken off, and its rank.
MatrixXd information_of(const RecordEstimate& estimate, Index& rank) {
  const VectorXd scale = estimate.prior.diagonal().cwiseSqrt();
  const VectorXd inverse = scale.cwiseInverse();
  const MatrixXd after = inverse.asDiagonal() * estimate.unknowns.covariance * inverse.asDiagonal(),
                 before = inverse.asDiagonal() * estimate.prior * inverse.asDiagonal();
  const MatrixXd raw = after.inverse() - before.inverse(), scaled = 0.5 * (raw + raw.transpose());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scaled);
  rank = (solver.eigenvalues().array() > determined).count();
  const MatrixXd positive = solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).asDiagonal() *
                            solver.eigenvectors().transpose();
  return inverse.asDiagonal() * positive * inverse.asDiagonal();
}

}  // namespace

SharedEstimate shared_estimate(const std::vector<NamedEstimate>& records) {
  if (records.empty()) throw std::invalid_argument("shared estimate: no record; expected one at least");
  SharedEstimate result;
  std::vector<EstimatePart> parts;
  std::vector<double> prior_mean, prior_information;
  Index rank_in_all = 0;
  for (const NamedEstimate& record : records) {
    EstimatePart part;
    Index rank = 0;
    part.information =
        information_of(record.estimate, rank) / (record.estimate.noise_ratio * record.estimate.noise_ratio);
    rank_in_all += rank;
    for (std::size_t i = 0; i < record.names.size(); ++i) {
      const auto found = std::find(result.names.begin(), result.names.end(), record.names[i]);
      part.places.push_back(found - result.names.begin());
      if (found != result.names.end()) continue;
      const auto at = static_cast<Index>(i);
      const bool nuisance = !record.estimate.nuisance.empty() && record.estimate.nuisance[i];
      result.names.push_back(record.names[i]);
      prior_information.push_back((nuisance ? 1.0 : weak_prior) / record.estimate.prior(at, at));
      prior_mean.push_back(nuisance && record.estimate.start.size() > 0 ? record.estimate.start[at]
                                                                        : record.estimate.unknowns.mean[at]);
    }
    parts.push_back(std::move(part));
  }
  const auto all = static_cast<Index>(result.names.size());
  const VectorXd known = Eigen::Map<const VectorXd>(prior_information.data(), all),
                 before = Eigen::Map<const VectorXd>(prior_mean.data(), all),
                 scale = known.cwiseSqrt().cwiseInverse();
  MatrixXd sum = known.asDiagonal();
  VectorXd weighted = VectorXd::Zero(all);  // of m - m_0
  for (std::size_t r = 0; r < parts.size(); ++r) {
    const std::vector<Index>& at = parts[r].places;
    sum(at, at) += parts[r].information;
    weighted(at) += parts[r].information * (records[r].estimate.unknowns.mean - before(at));
  }
  // In units of the prior no eigenvalue is below 1; where rounding says otherwise the records tell nothing.
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scale.asDiagonal() * sum * scale.asDiagonal());
  const VectorXd variances = solver.eigenvalues().cwiseMax(1.0).cwiseInverse();
  result.unknowns.covariance =
      scale.asDiagonal() *
      MatrixXd(solver.eigenvectors() * variances.asDiagonal() * solver.eigenvectors().transpose()) *
      scale.asDiagonal();
  result.unknowns.mean = before + result.unknowns.covariance * weighted;
  for (std::size_t r = 0; r < parts.size(); ++r) {
    const VectorXd off = records[r].estimate.unknowns.mean - result.unknowns.mean(parts[r].places);
    result.chi_squared += off.dot(parts[r].information * off);
  }
  result.freedom = std::max(0.0, static_cast<double>(rank_in_all - all));
  if (result.freedom > 0.0) {
    const boost::math::chi_squared law(result.freedom);
    result.probability = cdf(complement(law, result.chi_squared));
    if (result.probability < disagree_below)
      result.scatter = std::max(1.0, std::sqrt(result.chi_squared / result.freedom));
    result.unknowns.covariance *= result.scatter * result.scatter;
  }
  return result;
}

namespace {

constexpr int most_rounds = 6;
constexpr double settled_below = 0.1;  // of a deviation

const ComparedRun& run_of(const Comparison& one) {
  return one.runs.at(0);
}

Comparison identified(const FamilyMember& member, const Progress& progress) {
  Comparison found = identify_with_model(
      member.experiment, measured_record(member.record_name, member.record), member.folder, progress);
  if (!run_of(found).has_estimate())
    throw std::invalid_argument(
        fmt::format("{} with {}: {}", member.name, member.record_name, run_of(found).reason));
  return found;
}

NamedEstimate named_estimate(const ComparedRun& run) {
  NamedEstimate named{{}, record_estimate(run)};
  for (const Unknown& unknown : run.unknowns) named.names.push_back(unknown.name);
  return named;
}

// The first member's unknown of that name.
const Unknown& unknown_called(const std::string& name, const std::vector<Comparison>& all) {
  for (const Comparison& one : all)
    for (const Unknown& unknown : run_of(one).unknowns)
      if (unknown.name == name) return unknown;
  throw std::logic_error("no unknown '" + name + "'");
}

void check_alike(const BeamFamily& family) {
  bool any_shared = false;
  for (std::size_t r = 0; r < family.alone.size(); ++r)
    for (const Unknown& unknown : run_of(family.alone[r]).unknowns) {
      const Unknown& first = unknown_called(unknown.name, family.alone);
      any_shared = any_shared || &first != &unknown;
      if (first.form != unknown.form || first.unit != unknown.unit || first.nuisance != unknown.nuisance)
        throw std::invalid_argument(fmt::format(
            "parameter '{}' of {} has another form, unit or use than in the files before it; expected "
            "the same, or another name",
            unknown.name, family.members[r].name));
    }
  if (!any_shared)
    throw std::invalid_argument(
        "the experiment files share no parameter; expected one of the same name in at least two of them");
}

Estimate estimate_of(const Unknown& unknown, double mean, double deviation) {
  return {unknown.name,
          unknown.unit,
          unknown.to_physical(mean),
          std::abs(unknown.slope(mean)) * deviation,
          unknown.to_physical(mean - quantile_95 * deviation),
          unknown.to_physical(mean + quantile_95 * deviation),
          unknown.guess,
          unknown.deviation,
          unknown.nuisance};
}

// What all say, and the physical numbers at it.
void add_up(BeamFamily& family) {
  std::vector<NamedEstimate> estimates;
  for (const Comparison& one : family.alone) estimates.push_back(named_estimate(run_of(one)));
  family.estimate = shared_estimate(estimates);
  const Eigen::VectorXd deviations = family.estimate.unknowns.deviations();
  family.parameters.clear();
  for (std::size_t j = 0; j < family.estimate.names.size(); ++j)
    family.parameters.push_back(estimate_of(unknown_called(family.estimate.names[j], family.alone),
                                            family.estimate.unknowns.mean[static_cast<Index>(j)],
                                            deviations[static_cast<Index>(j)]));
}

using Deviations = std::vector<std::vector<double>>;  // of every member's unknowns, beforehand

Deviations deviations_of(const BeamFamily& family) {
  Deviations all;
  for (const Comparison& one : family.alone) {
    all.emplace_back();
    for (const Unknown& unknown : run_of(one).unknowns) all.back().push_back(unknown.deviation);
  }
  return all;
}

// Every file asks about its parameters from there, as uncertain as to weigh nothing, 1 / 30^2, and no more:
// what a record does not tell by itself would else wander along the curve of what fits it, where it is not
// linear.
void start_from(BeamFamily& family, const std::vector<Estimate>& before, const Deviations& first) {
  constexpr double uncertain = 30.0, moves = 3.0;
  for (std::size_t r = 0; r < family.members.size(); ++r) {
    auto& choices = family.members[r].experiment.parameters;
    const auto& unknowns = run_of(family.alone[r]).unknowns;
    for (std::size_t j = 0; j < choices.size() && j < unknowns.size(); ++j) {
      if (unknowns[j].nuisance) continue;
      const auto place = std::find_if(family.parameters.begin(), family.parameters.end(),
                                      [&](const Estimate& one) { return one.name == unknowns[j].name; });
      const auto which = static_cast<std::size_t>(place - family.parameters.begin());
      const double from = before.empty() ? unknowns[j].guess : before[which].value;
      choices[j].guess = place->value;
      choices[j].deviation = std::min(
          first[r][j], std::max(uncertain * place->deviation, moves * std::abs(place->value - from)));
      choices[j].relative_deviation.reset();
    }
  }
}

double largest_move(const std::vector<Estimate>& before, const std::vector<Estimate>& now) {
  double largest = 0.0;
  for (std::size_t j = 0; j < now.size(); ++j)
    largest = std::max(largest, std::abs(now[j].value - before[j].value) / now[j].deviation);
  return largest;
}

}  // namespace

BeamFamily identify_family(std::vector<FamilyMember> members, const Progress& progress) {
  for (const FamilyMember& member : members)
    if (member.experiment.parameters.empty())
      throw std::invalid_argument(
          member.name +
          " has no [[parameters]]; several beams share parameters by their names, expected "
          "model beam or modal with [[parameters]] in every file");
  BeamFamily family;
  family.members = std::move(members);
  Deviations first;
  while (family.rounds < most_rounds && !family.settled) {
    ++family.rounds;
    family.alone.clear();
    for (const FamilyMember& member : family.members) {
      progress(fmt::format("round {}: {}", family.rounds, member.name));
      family.alone.push_back(identified(member, [](const std::string&) {}));
    }
    if (family.rounds == 1) {
      check_alike(family);
      first = deviations_of(family);
    }
    const std::vector<Estimate> before = family.parameters;
    add_up(family);
    family.settled = !before.empty() && largest_move(before, family.parameters) < settled_below;
    start_from(family, before, first);
  }
  for (const std::string& name : family.estimate.names) {
    std::string beams;
    for (std::size_t r = 0; r < family.members.size(); ++r)
      for (const Unknown& unknown : run_of(family.alone[r]).unknowns)
        if (unknown.name == name) beams += (beams.empty() ? "" : ", ") + family.members[r].name;
    family.shared_by.push_back(beams);
  }
  return family;
}

}  // namespace beamid::experiments
