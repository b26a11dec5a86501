// Another damping in place of that described: ratios of modes, or dashpots in the storeys.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "experiments/identify/driven/driven_fit.hpp"
#include "experiments/identify/driven/other_models.hpp"
#include "experiments/models/estimates.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Index most_modes = 12;

/// |z| of the same significance as chi^2 of so many degrees of freedom [wilson1931].
double normal_of_chi_squared(double value, double freedom) {
  const double spread = 2.0 / (9.0 * freedom);
  return (std::cbrt(value / freedom) - 1.0 + spread) / std::sqrt(spread);
}

/// The unknowns of a description by what they are about.
struct Unknowns {
  std::vector<Index> damping, others;
};

/// Absent where its parameters are not its unknowns, or a law of all masses and stiffnesses damps it.
std::optional<Unknowns> unknowns_of(const Experiment& experiment, const JointModel& model) {
  Unknowns found;
  if (model.unknowns.size() != experiment.parameters.size()) return {};
  for (std::size_t j = 0; j < experiment.parameters.size(); ++j) {
    const std::string& asked = experiment.parameters[j].quantity;
    if (asked != model.unknowns[j].quantity || asked == "mass_damping" || asked == "stiffness_damping")
      return {};
    const bool damps = asked == "damping_ratio" || asked == "storey_damping";
    (damps ? found.damping : found.others).push_back(static_cast<Index>(j));
  }
  return found;
}

/// An experiment in which these parameters determine the damping, behind all others.
Experiment damped_by(const Experiment& experiment, const Unknowns& unknowns, const fem::DampingLaw& law,
                     const std::vector<ParameterChoice>& own) {
  Experiment other = experiment;
  other.damping = law;
  other.parameters.clear();
  for (const Index j : unknowns.others)
    other.parameters.push_back(experiment.parameters[static_cast<std::size_t>(j)]);
  other.parameters.insert(other.parameters.end(), own.begin(), own.end());
  return other;
}

/// The same lines with another damping: what is known of the other unknowns stays.
/// @param mean, variance of the damping's, each
DrivenProblem with_damping(const DrivenProblem& problem, const JointModel& model, const Unknowns& unknowns,
                           const VectorXd& mean, double variance) {
  const auto kept = static_cast<Index>(unknowns.others.size());
  DrivenProblem other = problem;
  other.model = &model;
  other.prior.mean.resize(kept + mean.size());
  other.prior.mean << problem.prior.mean(unknowns.others), mean;
  const MatrixXd before = problem.prior.marginal(0, problem.prior.mean.size());
  other.prior.covariance = MatrixXd::Zero(other.prior.mean.size(), other.prior.mean.size());
  other.prior.covariance.topLeftCorner(kept, kept) = before(unknowns.others, unknowns.others);
  other.prior.covariance.diagonal().tail(mean.size()).setConstant(variance);
  other.prior.factor.resize(0, 0);
  return other;
}

/// "1.2 +- 0.1, 0.8 +- 0.2" of the damping's unknowns. @param scale of what is printed to their unit
std::string values_text(const DrivenProblem& problem, const DrivenFit& fit, Index first, double scale) {
  const VectorXd deviation = fit.covariance(problem.prior).diagonal().cwiseSqrt();
  std::string text;
  for (Index j = first; j < fit.theta.size(); ++j) {
    const Unknown& own = problem.model->unknowns[static_cast<std::size_t>(j)];
    const double value = own.to_physical(fit.theta[j]),
                 upper = own.to_physical(fit.theta[j] + quantile_95 * deviation[j]);
    text +=
        fmt::format("{}{:.3g} +- {:.2g}", text.empty() ? "" : ", ", scale * value, scale * (upper - value));
  }
  return text;
}

/// How the unknowns beside the damping move (q).
VectorXd moved_to(const DrivenFit& fit, const Unknowns& unknowns, const VectorXd& theta) {
  VectorXd moved = VectorXd::Zero(theta.size());
  for (std::size_t j = 0; j < unknowns.others.size(); ++j)
    moved[unknowns.others[j]] = fit.theta[static_cast<Index>(j)] - theta[unknowns.others[j]];
  return moved;
}

std::vector<ParameterChoice> ratios_of_modes(Index modes, const ParameterChoice& like) {
  std::vector<ParameterChoice> own(static_cast<std::size_t>(modes), like);
  for (Index m = 0; m < modes; ++m) {
    own[static_cast<std::size_t>(m)].mode = static_cast<int>(m) + 1;
    own[static_cast<std::size_t>(m)].name.clear();
  }
  return own;
}

/// In the band, and to an octave above it.
Index count_modes(const DrivenProblem& problem) {
  const double highest = 2.0 * problem.parts.front().omega.maxCoeff();
  return std::min<Index>(most_modes, (problem.model->mode_frequencies.array() < highest).count());
}

/// What ratios of their own of the modes explain beyond the one that is asked of all, all together: with D
/// their slopes beyond J, s = D^T r, and V = sum_k d_k d_k^T r'_k^2 over the lines, r' what is left with
/// them, s^T V^-1 s is chi^2 [white1982].
void add_modal_ratios(const DrivenProblem& problem, const OtherModels& models, const Experiment& experiment,
                      const LineScores& left, const Unknowns& unknowns, const VectorXd& theta,
                      std::vector<DescriptionFault>& faults) {
  const Index modes = count_modes(problem), kept = theta.size() - 1;
  if (unknowns.damping.size() != 1 || modes < 2) return;
  const Index at = unknowns.damping.front();
  const ParameterChoice& asked = experiment.parameters[static_cast<std::size_t>(at)];
  if (asked.quantity != "damping_ratio" || asked.mode) return;
  const Unknown& ratio = problem.model->unknowns[static_cast<std::size_t>(at)];
  const JointModel model =
      models.of(damped_by(experiment, unknowns, fem::ModalDamping{{ratio.to_physical(theta[at])}},
                          ratios_of_modes(modes, asked)));
  const DrivenProblem there =
      with_damping(problem, model, unknowns, VectorXd::Constant(modes, problem.prior.mean[at]),
                   problem.prior.marginal(at, 1)(0, 0));
  VectorXd start(kept + modes);
  start << theta(unknowns.others), VectorXd::Constant(modes, theta[at]);
  const LineScores all(there, start);
  const double score =
      normal_of_chi_squared(left.together(all.slopes().rightCols(modes)), static_cast<double>(modes - 1));
  if (!(score > sure_score)) return;
  const DrivenFit fit = fit_driven_from(there, start, 20);
  const double whole = evaluate_driven(problem, theta).cost;
  if (!(fit.cost < whole)) return;
  faults.push_back({fmt::format("the damping ratio is not one of all modes: by the record {} % in modes 1 to "
                                "{}, which [[parameters]] with mode = 1, 2, ... determine",
                                values_text(there, fit, kept, 100.0), modes),
                    score, 1.0 - fit.cost / whole, moved_to(fit, unknowns, theta)});
}

/// The most of the residual that a lag of one channel or of all inputs explains: dashpots turn phases, too.
double explained_by_lags(const DrivenProblem& problem, const LineScores& left) {
  double most = 0.0;
  for (Index i = -1; i < problem.weights.size(); ++i)
    if (const auto score = left.score(left.lag_of(i < 0 ? std::nullopt : std::optional(i))))
      most = std::max(most, score->explained);
  return most;
}

/// Adds a damping of another kind, which does not hold that described: by the likelihood.
void add_damping(const DrivenProblem& problem, const OtherModels& models, const Experiment& other,
                 const LineScores& left, const Unknowns& unknowns, const VectorXd& theta,
                 const std::function<std::string(const DrivenProblem&, const DrivenFit&)>& sentence,
                 std::vector<DescriptionFault>& faults) {
  constexpr double deviation = 1.5;  // of logarithms: within a factor of 20 of a guess
  const JointModel model = models.of(other);
  const auto kept = static_cast<Index>(unknowns.others.size()),
             own = static_cast<Index>(model.unknowns.size()) - kept;
  VectorXd mean(own);
  for (Index j = 0; j < own; ++j) {
    const Unknown& unknown = model.unknowns[static_cast<std::size_t>(kept + j)];
    mean[j] = unknown.to_state(unknown.guess);
  }
  const DrivenProblem there = with_damping(problem, model, unknowns, mean, deviation * deviation);
  VectorXd start(kept + own);
  start << theta(unknowns.others), mean;
  const DrivenFit fit = fit_driven_from(there, start, 30);
  const double share = std::max(fit.cost / evaluate_driven(problem, theta).cost, 1e-300),
               lines = static_cast<double>(2 * problem.parts.front().outputs.size()),
               score = std::sqrt(lines * -std::log(std::min(share, 1.0)));
  if (!(score > sure_score) || !(1.0 - share > explained_by_lags(problem, left))) return;
  faults.push_back({sentence(there, fit), score, 1.0 - share, moved_to(fit, unknowns, theta)});
}

/// A parameter of each storey from the base up.
std::vector<ParameterChoice> of_storeys(const fem::Beam& chain, const std::string& quantity) {
  std::vector<ParameterChoice> own;
  double height = 0.0;
  for (const fem::Segment& storey : chain.segments) {
    ParameterChoice one;
    one.quantity = quantity;
    one.region = {height, height + storey.length};
    one.keep_positive = true;
    own.push_back(one);
    height += storey.length;
  }
  return own;
}

/// c = 2 xi k / omega of the lowest mode, which all of these together damp by xi.
void add_storey_dashpots(const DrivenProblem& problem, const OtherModels& models,
                         const Experiment& experiment, const LineScores& left, const Unknowns& unknowns,
                         const VectorXd& theta, std::vector<DescriptionFault>& faults) {
  const auto* law = std::get_if<fem::ModalDamping>(&experiment.damping);
  double ratio = law->ratios.front();
  if (!unknowns.damping.empty()) {
    const Index at = unknowns.damping.front();
    ratio = problem.model->unknowns[static_cast<std::size_t>(at)].to_physical(theta[at]);
  }
  std::vector<ParameterChoice> own = of_storeys(experiment.structure.beam(), "storey_damping");
  for (ParameterChoice& one : own) {
    const double stiffness =
        fem::value_of(experiment.structure, {fem::BeamParameter::Quantity::storey_stiffness, one.region});
    one.guess = 2.0 * ratio * stiffness / problem.model->mode_frequencies.minCoeff();
  }
  add_damping(
      problem, models, damped_by(experiment, unknowns, fem::Undamped{}, own), left, unknowns, theta,
      [&](const DrivenProblem& there, const DrivenFit& fit) {
        return fmt::format(
            "dashpots in the storeys damp it, not ratios of modes: by the record {} N s/m from the "
            "base up, which [[parameters]] of \"storey_damping\" determine",
            values_text(there, fit, static_cast<Index>(unknowns.others.size()), 1.0));
      },
      faults);
}

void add_ratios_for_dashpots(const DrivenProblem& problem, const OtherModels& models,
                             const Experiment& experiment, const LineScores& left, const Unknowns& unknowns,
                             const VectorXd& theta, std::vector<DescriptionFault>& faults) {
  constexpr double usual_ratio = 0.02;
  const Index modes = count_modes(problem);
  fem::Beam chain = experiment.structure.beam();
  for (fem::Segment& storey : chain.segments) storey.dashpot = 0.0;
  ParameterChoice ratio;
  ratio.quantity = "damping_ratio";
  ratio.guess = usual_ratio;
  ratio.keep_positive = true;
  Experiment other =
      damped_by(experiment, unknowns, fem::ModalDamping{{usual_ratio}}, ratios_of_modes(modes, ratio));
  other.structure = chain;
  add_damping(
      problem, models, other, left, unknowns, theta,
      [&](const DrivenProblem& there, const DrivenFit& fit) {
        return fmt::format(
            "ratios of modes damp it, not dashpots in the storeys: by the record {} % in modes 1 to "
            "{}, which law = \"modal\" in [damping] and [[parameters]] with mode = 1, 2, ... "
            "determine",
            values_text(there, fit, static_cast<Index>(unknowns.others.size()), 100.0), modes);
      },
      faults);
}

}  // namespace

void add_other_damping(const DrivenProblem& problem, const OtherModels& models, const Experiment& experiment,
                       const LineScores& left, const VectorXd& theta, std::vector<DescriptionFault>& faults) {
  const auto unknowns = unknowns_of(experiment, *problem.model);
  if (!unknowns) return;
  const auto add = [&](const auto& alternative) {
    try {
      alternative();
    } catch (const std::exception&) {  // there is no such model, or it does not move so
    }
  };
  const bool has_ratios = std::holds_alternative<fem::ModalDamping>(experiment.damping),
             is_undamped = std::holds_alternative<fem::Undamped>(experiment.damping);
  if (has_ratios) add([&] { add_modal_ratios(problem, models, experiment, left, *unknowns, theta, faults); });
  if (!experiment.structure.is_chain()) return;
  const std::vector<fem::Segment>& storeys = experiment.structure.beam().segments;
  if (std::ssize(storeys) > most_modes) return;
  const bool has_dashpots =
      std::ranges::any_of(storeys, [](const fem::Segment& one) { return one.dashpot > 0.0; });
  if (has_ratios && !has_dashpots)
    add([&] { add_storey_dashpots(problem, models, experiment, left, *unknowns, theta, faults); });
  if (is_undamped && has_dashpots)
    add([&] { add_ratios_for_dashpots(problem, models, experiment, left, *unknowns, theta, faults); });
}

}  // namespace beamid::experiments
