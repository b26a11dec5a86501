// Another damping in place of that described: ratios of modes, or dashpots in the storeys.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
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
    const std::string& quantity = experiment.parameters[j].quantity;
    if (quantity != model.unknowns[j].quantity || quantity == "mass_damping" ||
        quantity == "stiffness_damping")
      return {};
    const bool damps = quantity == "damping_ratio" || quantity == "storey_damping";
    (damps ? found.damping : found.others).push_back(static_cast<Index>(j));
  }
  return found;
}

std::vector<ParameterChoice> ratios_of_modes(Index modes, const ParameterChoice& like) {
  std::vector<ParameterChoice> own(static_cast<std::size_t>(modes), like);
  for (Index m = 0; m < modes; ++m) {
    own[static_cast<std::size_t>(m)].mode = static_cast<int>(m) + 1;
    own[static_cast<std::size_t>(m)].name.clear();
  }
  return own;
}

/// A record with other dampings in place of that described. What it is made from outlives it.
class OtherDampings {
 public:
  /// @param theta of the problem's unknowns (q)
  OtherDampings(const DrivenProblem& problem, const OtherModels& models, const Experiment& experiment,
                const LineScores& left, Unknowns unknowns, const VectorXd& theta,
                std::vector<DescriptionFault>& faults)
      : problem_(problem),
        models_(models),
        experiment_(experiment),
        left_(left),
        unknowns_(std::move(unknowns)),
        theta_(theta),
        whole_(evaluate_driven(problem, theta).cost),
        faults_(faults) {}

  void add_modal_ratios();
  void add_storey_dashpots();
  void add_ratios_for_dashpots();

 private:
  Index kept() const { return static_cast<Index>(unknowns_.others.size()); }
  Index count_modes() const;
  Experiment damped_by(const fem::DampingLaw& law, const std::vector<ParameterChoice>& own) const;
  DrivenProblem problem_of(const JointModel& model, const VectorXd& mean, double variance) const;
  VectorXd start_with(const VectorXd& own) const;
  std::string values_text(const DrivenProblem& there, const DrivenFit& fit, double scale) const;
  double explained_by_lags() const;
  void add(const std::string& sentence, double score, const DrivenFit& fit);
  void add_likelier(const Experiment& other, const std::string& what, double scale, const std::string& which);

  const DrivenProblem& problem_;
  const OtherModels& models_;
  const Experiment& experiment_;
  const LineScores& left_;
  Unknowns unknowns_;
  const VectorXd& theta_;
  double whole_;  ///< J as described
  std::vector<DescriptionFault>& faults_;
};

/// In the band, and to an octave above it.
Index OtherDampings::count_modes() const {
  const double highest = 2.0 * problem_.parts.front().omega.maxCoeff();
  return std::min<Index>(most_modes, (problem_.model->mode_frequencies.array() < highest).count());
}

/// An experiment in which these parameters determine the damping, behind all others.
Experiment OtherDampings::damped_by(const fem::DampingLaw& law,
                                    const std::vector<ParameterChoice>& own) const {
  Experiment other = experiment_;
  other.damping = law;
  other.parameters.clear();
  for (const Index j : unknowns_.others)
    other.parameters.push_back(experiment_.parameters[static_cast<std::size_t>(j)]);
  other.parameters.insert(other.parameters.end(), own.begin(), own.end());
  return other;
}

/// The same lines with another damping: what is known of the other unknowns stays.
/// @param mean, variance of the damping's, each
DrivenProblem OtherDampings::problem_of(const JointModel& model, const VectorXd& mean,
                                        double variance) const {
  DrivenProblem other = problem_;
  other.model = &model;
  other.prior.mean.resize(kept() + mean.size());
  other.prior.mean << problem_.prior.mean(unknowns_.others), mean;
  const MatrixXd before = problem_.prior.marginal(0, problem_.prior.mean.size());
  other.prior.covariance = MatrixXd::Zero(other.prior.mean.size(), other.prior.mean.size());
  other.prior.covariance.topLeftCorner(kept(), kept()) = before(unknowns_.others, unknowns_.others);
  other.prior.covariance.diagonal().tail(mean.size()).setConstant(variance);
  other.prior.factor.resize(0, 0);
  return other;
}

VectorXd OtherDampings::start_with(const VectorXd& own) const {
  VectorXd start(kept() + own.size());
  start << theta_(unknowns_.others), own;
  return start;
}

/// "1.2 +- 0.1, 0.8 +- 0.2" of the damping's unknowns. @param scale of what is printed to their unit
std::string OtherDampings::values_text(const DrivenProblem& there, const DrivenFit& fit, double scale) const {
  const VectorXd deviation = fit.covariance(there.prior).diagonal().cwiseSqrt();
  std::string text;
  for (Index j = kept(); j < fit.theta.size(); ++j) {
    const Unknown& own = there.model->unknowns[static_cast<std::size_t>(j)];
    const double value = own.to_physical(fit.theta[j]),
                 upper = own.to_physical(fit.theta[j] + quantile_95 * deviation[j]);
    text +=
        fmt::format("{}{:.3g} +- {:.2g}", text.empty() ? "" : ", ", scale * value, scale * (upper - value));
  }
  return text;
}

/// The most of the residual that a lag of one channel or of all inputs explains: dashpots turn phases, too.
double OtherDampings::explained_by_lags() const {
  double most = 0.0;
  for (Index i = -1; i < problem_.weights.size(); ++i)
    if (const auto score = left_.score(left_.lag_of(i < 0 ? std::nullopt : std::optional(i))))
      most = std::max(most, score->explained);
  return most;
}

void OtherDampings::add(const std::string& sentence, double score, const DrivenFit& fit) {
  VectorXd moved = VectorXd::Zero(theta_.size());
  moved(unknowns_.others) = fit.theta.head(kept()) - theta_(unknowns_.others);
  faults_.push_back({sentence, score, 1.0 - fit.cost / whole_, moved});
}

/// What ratios of their own of the modes explain beyond the one that is common to all, all together: with D
/// their slopes beyond J, s = D^T r, and V = sum_k d_k d_k^T r'_k^2 over the lines, r' what is left with
/// them, s^T V^-1 s is chi^2 [white1982].
void OtherDampings::add_modal_ratios() {
  const Index modes = count_modes();
  if (unknowns_.damping.size() != 1 || modes < 2) return;
  const Index at = unknowns_.damping.front();
  const ParameterChoice& common = experiment_.parameters[static_cast<std::size_t>(at)];
  if (common.quantity != "damping_ratio" || common.mode) return;
  const Unknown& ratio = problem_.model->unknowns[static_cast<std::size_t>(at)];
  const JointModel model = models_.of(
      damped_by(fem::ModalDamping{{ratio.to_physical(theta_[at])}}, ratios_of_modes(modes, common)));
  const DrivenProblem there = problem_of(model, VectorXd::Constant(modes, problem_.prior.mean[at]),
                                         problem_.prior.marginal(at, 1)(0, 0));
  const VectorXd start = start_with(VectorXd::Constant(modes, theta_[at]));
  const LineScores all(there, start);
  const double score =
      normal_of_chi_squared(left_.together(all.slopes().rightCols(modes)), static_cast<double>(modes - 1));
  if (!(score > sure_score)) return;
  const DrivenFit fit = fit_driven_from(there, start, 20);
  if (!(fit.cost < whole_)) return;
  add(fmt::format("the damping ratio is not one of all modes: by the record {} % in modes 1 to {}, which "
                  "[[parameters]] with mode = 1, 2, ... determine",
                  values_text(there, fit, 100.0), modes),
      score, fit);
}

/// Adds a damping of another kind, which does not hold that described: by the likelihood.
/// @param what the sentence up to its values, @param scale of these, @param which what follows them
void OtherDampings::add_likelier(const Experiment& other, const std::string& what, double scale,
                                 const std::string& which) {
  constexpr double deviation = 1.5;  // of logarithms: within a factor of 20 of a guess
  const JointModel model = models_.of(other);
  VectorXd mean(static_cast<Index>(model.unknowns.size()) - kept());
  for (Index j = 0; j < mean.size(); ++j) {
    const Unknown& unknown = model.unknowns[static_cast<std::size_t>(kept() + j)];
    mean[j] = unknown.to_state(unknown.guess);
  }
  const DrivenProblem there = problem_of(model, mean, deviation * deviation);
  const DrivenFit fit = fit_driven_from(there, start_with(mean), 30);
  const double share = std::clamp(fit.cost / whole_, 1e-300, 1.0),
               lines = static_cast<double>(2 * problem_.parts.front().outputs.size()),
               score = std::sqrt(lines * -std::log(share));
  if (!(score > sure_score) || !(1.0 - share > explained_by_lags())) return;
  add(fmt::format("{} by the record {} {}", what, values_text(there, fit, scale), which), score, fit);
}

/// c = 2 xi k / omega of the lowest mode, which all of these together damp by xi.
void OtherDampings::add_storey_dashpots() {
  double ratio = std::get<fem::ModalDamping>(experiment_.damping).ratios.front();
  if (!unknowns_.damping.empty()) {
    const Index at = unknowns_.damping.front();
    ratio = problem_.model->unknowns[static_cast<std::size_t>(at)].to_physical(theta_[at]);
  }
  std::vector<ParameterChoice> own;
  double height = 0.0;
  for (const fem::Segment& storey : experiment_.structure.beam().segments) {
    ParameterChoice dashpot;
    dashpot.quantity = "storey_damping";
    dashpot.region = {height, height + storey.length};
    height += storey.length;
    dashpot.keep_positive = true;
    const double stiffness = fem::value_of(experiment_.structure,
                                           {fem::BeamParameter::Quantity::storey_stiffness, dashpot.region});
    dashpot.guess = 2.0 * ratio * stiffness / problem_.model->mode_frequencies.minCoeff();
    own.push_back(std::move(dashpot));
  }
  add_likelier(damped_by(fem::Undamped{}, own), "dashpots in the storeys damp it, not ratios of modes:", 1.0,
               "N s/m from the base up, which [[parameters]] of \"storey_damping\" determine");
}

void OtherDampings::add_ratios_for_dashpots() {
  constexpr double usual_ratio = 0.02;
  const Index modes = count_modes();
  fem::Beam chain = experiment_.structure.beam();
  for (fem::Segment& storey : chain.segments) storey.dashpot = 0.0;
  ParameterChoice ratio;
  ratio.quantity = "damping_ratio";
  ratio.guess = usual_ratio;
  ratio.keep_positive = true;
  Experiment other = damped_by(fem::ModalDamping{{usual_ratio}}, ratios_of_modes(modes, ratio));
  other.structure = chain;
  add_likelier(
      other, "ratios of modes damp it, not dashpots in the storeys:", 100.0,
      fmt::format("% in modes 1 to {}, which law = \"modal\" in [damping] and [[parameters]] with mode "
                  "= 1, 2, ... determine",
                  modes));
}

}  // namespace

void add_other_damping(const DrivenProblem& problem, const OtherModels& models, const Experiment& experiment,
                       const LineScores& left, const VectorXd& theta, std::vector<DescriptionFault>& faults) {
  const auto unknowns = unknowns_of(experiment, *problem.model);
  if (!unknowns) return;
  OtherDampings others(problem, models, experiment, left, *unknowns, theta, faults);
  const auto attempt = [&](void (OtherDampings::*alternative)()) {
    try {
      (others.*alternative)();
    } catch (const std::exception&) {  // there is no such model, or it does not move so
    }
  };
  const bool has_ratios = std::holds_alternative<fem::ModalDamping>(experiment.damping),
             is_undamped = std::holds_alternative<fem::Undamped>(experiment.damping);
  if (has_ratios) attempt(&OtherDampings::add_modal_ratios);
  if (!experiment.structure.is_chain()) return;
  const std::vector<fem::Segment>& storeys = experiment.structure.beam().segments;
  if (std::ssize(storeys) > most_modes) return;
  const bool has_dashpots =
      std::ranges::any_of(storeys, [](const fem::Segment& one) { return one.dashpot > 0.0; });
  if (has_ratios && !has_dashpots) attempt(&OtherDampings::add_storey_dashpots);
  if (is_undamped && has_dashpots) attempt(&OtherDampings::add_ratios_for_dashpots);
}

}  // namespace beamid::experiments
