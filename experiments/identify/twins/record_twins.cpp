#include "experiments/identify/twins/record_twins.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "experiments/identify/driven/driven_part.hpp"
#include "experiments/identify/engine/first_guess.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/twins/twins.hpp"
#include "experiments/identify/update/update_study.hpp"
#include "experiments/identify/verdict/reproduction.hpp"
#include "experiments/models/joint_model.hpp"
#include "filters/batch_estimator.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr std::size_t most_stiffnesses = 8;
constexpr Index most_coordinates = 80;
constexpr int few_starts = 40;
constexpr ModelTrust exactly{0.0005, 0.03};

/// The structure with the parameters that were found, nothing else known of them: what its frequencies say.
struct FoundStructure {
  Experiment experiment;
  std::vector<Index> places;  ///< of its parameters among the run's (q)
};

FoundStructure structure_found(const Experiment& experiment, const ComparedRun& run) {
  FoundStructure result{experiment, {}};
  result.experiment.parameters.clear();
  for (std::size_t j = 0; j < run.unknowns.size(); ++j) {
    const Unknown& unknown = run.unknowns[j];
    if (!is_stiffness(unknown.quantity) || unknown.nuisance || unknown.mode) continue;
    ParameterChoice choice{unknown.quantity, unknown.name, unknown.region};
    choice.guess = run.parameters[j].estimate.value;
    result.experiment.parameters.push_back(choice);
    result.places.push_back(static_cast<Index>(j));
  }
  return result;
}

bool worth_a_search(const FoundStructure& found, const Comparison& comparison) {
  const ComparedRun& run = comparison.runs.front();
  const std::size_t asked = found.places.size();
  return run.has_estimate() && !run.oscillator && run.run.last.mean.size() > 0 && asked >= 2 &&
         asked <= most_stiffnesses && run.coordinates >= static_cast<Index>(asked) &&
         !is_nonlinear(*run.model) && !has_noise(run.settings.input_noise) &&
         fem::assemble(found.experiment.structure, found.experiment.elements).size() <= most_coordinates;
}

/// Output error of the record from a set of unknowns on.
class RecordFit {
 public:
  RecordFit(const Experiment& experiment, const Comparison& comparison, const std::filesystem::path& folder)
      : experiment_(experiment),
        run_(comparison.runs.front()),
        setting_(model_setting(experiment, comparison.analysis.record, experiment.reduction, folder)),
        record_(measurements(comparison.analysis.record)) {
    constexpr Index enough_lines = 2048;
    const VectorXd here = run_.unknown_state.mean;
    lines_ = driven_problem(*run_.model, record_, {here, stated_deviations().cwiseAbs2().asDiagonal(), {}});
    if (!lines_) return;
    RecordLines& part = lines_->parts.front();
    part = thinned(part, std::max<Index>(part.omega.size() / enough_lines, 1));
    try {
      lines_->weights.setOnes(record_.outputs.rows());
      for (int i = 0; i < 2; ++i)
        lines_->weights = evaluate_driven(*lines_, here).left.cwiseMax(1e-150).cwiseInverse();
      const DrivenFit fit = fit_driven_from(*lines_, here);
      here_ = fit.theta;
      left_ = fit.left_share;
    } catch (const std::runtime_error&) {  // no motion there
      lines_.reset();
    }
  }

  /// @param unknowns as the state carries them (q)
  /// @returns nothing where the motion from there does not stay finite
  std::optional<filters::BatchEstimate> from(const VectorXd& unknowns) const {
    try {
      return moved_from(unknowns);
    } catch (const std::runtime_error&) {
      return {};
    }
  }

  /// Where the lines of a driven record with more than its noise left lead a set, in a hundredth of the time
  /// that all samples take. A clean one would have to be searched finer than their slopes are: the set
  /// itself.
  /// @returns absent where they decide against it, or lead it to the estimate
  std::optional<VectorXd> led_by_lines(const VectorXd& unknowns) const {
    constexpr double plain = 0.05;                // of the lines, not explained by the estimate
    constexpr double more = 1.1, hopeless = 2.0;  // times that, at the end and on the way there
    constexpr int most_steps = 180;
    if (!lines_ || left_ < plain) return unknowns;
    try {
      DrivenProblem from_there = *lines_;
      from_there.prior.mean = unknowns;
      const DrivenFit fit = fit_driven_from(from_there, unknowns, most_steps);
      if (fit.left_share > (fit.converged ? more : hopeless) * left_ || (fit.converged && is_here(fit.theta)))
        return {};
      return fit.converged ? fit.theta : unknowns;
    } catch (const std::runtime_error&) {  // no motion there
      return unknowns;
    }
  }

 private:
  filters::BatchEstimate moved_from(const VectorXd& unknowns) const {
    VectorXd state = run_.run.last.mean;
    state(run_.model->unknown_places) = unknowns;
    const JointModel model = on_basis_at(experiment_.model, setting_, *run_.model, state);
    const double duration = record_.interval() * static_cast<double>(record_.time.size());
    const StartDirections directions = start_directions(
        model, setting_.observations, start_scale(model, setting_.observations, record_.outputs, duration));
    const auto discrete = finest(model, record_.interval(), run_.settings.output_noise);
    const Reproduction motion = reproduce(*discrete, state, directions, record_);
    filters::BatchSettings settings;
    settings.max_iterations = 25;
    settings.tolerance = 1e-2;
    filters::BatchEstimate fit =
        filters::estimate_batch(*discrete, motion.initial_state, directions.all(), record_, settings);
    if (fit.costs.empty()) throw std::runtime_error(fit.reason);
    return fit;
  }

  // Each unknown is within 1 % of where the estimate leads.
  bool is_here(const VectorXd& unknowns) const {
    for (Index j = 0; j < unknowns.size(); ++j) {
      const Unknown& unknown = run_.unknowns[static_cast<std::size_t>(j)];
      const double here = unknown.to_physical(here_[j]);
      if (std::abs(unknown.to_physical(unknowns[j]) - here) > 0.01 * std::abs(here)) return false;
    }
    return true;
  }

  // What the experiment states of the unknowns, in the coordinates of the state (q).
  VectorXd stated_deviations() const {
    VectorXd found(static_cast<Index>(run_.unknowns.size()));
    for (Index j = 0; j < found.size(); ++j) {
      const Unknown& unknown = run_.unknowns[static_cast<std::size_t>(j)];
      found[j] = unknown.deviation / std::abs(unknown.slope(unknown.to_state(unknown.guess)));
    }
    return found;
  }

  const Experiment& experiment_;
  const ComparedRun& run_;
  ModelSetting setting_;
  filters::Measurements record_;
  std::optional<DrivenProblem> lines_;  // of a driven record, every so many
  VectorXd here_;                       // where the estimate leads on them
  double left_ = 0.0;                   // of them, there
};

// From what the experiment states, not from what a first fit has made of it.
double distance_to_prior(const ComparedRun& run, const VectorXd& unknowns) {
  double squares = 0.0;
  for (Index j = 0; j < unknowns.size(); ++j) {
    const Unknown& unknown = run.unknowns[static_cast<std::size_t>(j)];
    const double guess = unknown.to_state(unknown.guess),
                 deviation = unknown.deviation / std::abs(unknown.slope(guess));
    squares += std::pow((unknowns[j] - guess) / deviation, 2);
  }
  return squares;
}

// In one of the stiffnesses by more than 2 %.
bool differ(const VectorXd& a, const VectorXd& b, const std::vector<Index>& places) {
  return std::any_of(places.begin(), places.end(),
                     [&](Index j) { return std::abs(a[j] - b[j]) > 0.02 * std::abs(b[j]); });
}

// Outside the 95 % interval of one of the stiffnesses: within all of them it is the same answer.
bool is_another(const VectorXd& values, const ComparedRun& run, const std::vector<Index>& places) {
  return std::any_of(places.begin(), places.end(), [&](Index j) {
    const auto place = static_cast<std::size_t>(j);
    if (place >= run.parameters.size()) return true;
    const Estimate& known = run.parameters[place].estimate;
    return values[j] < known.lower_95 || values[j] > known.upper_95;
  });
}

std::vector<VectorXd> same_frequencies(const UpdateStudy& study, const FoundStructure& found,
                                       const ComparedRun& run) {
  std::vector<VectorXd> others;
  const VectorXd here = unknown_values(*run.model, run.run.last.mean);
  for (const ParameterSet& set : study.updating.sets) {
    VectorXd values = here;
    values(found.places) = set.values;
    if (!set.as_well || !differ(values, here, found.places)) continue;
    VectorXd unknowns = run.unknown_state.mean;
    try {
      for (const Index j : found.places)
        unknowns[j] = run.unknowns[static_cast<std::size_t>(j)].to_state(values[j]);
    } catch (const std::invalid_argument&) {  // outside its bounds
      continue;
    }
    others.push_back(unknowns);
  }
  return others;
}

// The experiment with its stiffnesses guessed where a twin has them, as uncertain as before.
Experiment started_from(Experiment experiment, const ComparedRun& run, const RecordTwin& twin) {
  for (std::size_t j = 0; j < std::min(experiment.parameters.size(), run.unknowns.size()); ++j) {
    ParameterChoice& choice = experiment.parameters[j];
    const Unknown& unknown = run.unknowns[j];
    if (choice.quantity != unknown.quantity || !is_stiffness(unknown.quantity) || unknown.mode) continue;
    choice.guess = twin.values[static_cast<Index>(j)];
    choice.deviation = unknown.deviation;
    choice.relative_deviation.reset();
  }
  return experiment;
}

std::string not_unique_text(const RecordTwins& twins) {
  const std::size_t others = twins.undecided();
  double least = deciding_chi_square;
  for (const RecordTwin& twin : twins.sets)
    if (twin.is_undecided()) least = std::min(least, twin.more());
  return fmt::format(
      "NOT UNIQUE: at least {} other set{} of parameters explain{} this record as well (chi^2 {:+.2g}, with "
      "what was "
      "known beforehand; 6 would decide). The intervals are those of one of {} answers.",
      others, others == 1 ? "" : "s", others == 1 ? "s" : "", least, others + 1);
}

}  // namespace

const RecordTwin* RecordTwins::better() const {
  const auto least = std::min_element(
      sets.begin(), sets.end(), [](const RecordTwin& a, const RecordTwin& b) { return a.more() < b.more(); });
  return least != sets.end() && least->more() < -deciding_chi_square ? &*least : nullptr;
}

std::size_t RecordTwins::undecided() const {
  return static_cast<std::size_t>(
      std::count_if(sets.begin(), sets.end(), std::mem_fn(&RecordTwin::is_undecided)));
}

RecordTwins record_twins(const Experiment& experiment, const Comparison& comparison,
                         const std::filesystem::path& folder, const Progress& progress) {
  RecordTwins result;
  const ComparedRun& run = comparison.runs.front();
  const FoundStructure found = structure_found(experiment, run);
  if (!worth_a_search(found, comparison)) return result;
  const UpdateStudy study =
      study_update(found.experiment, described_modes(found.experiment), {exactly, few_starts});
  if (study.updating.continuum()) return result;  // which the bounds tell
  std::vector<VectorXd> others = same_frequencies(study, found, run);
  result.tried = others.size();
  if (others.empty()) return result;

  const RecordFit record(experiment, comparison, folder);
  Countdown tried(progress, 2 * others.size(), "other sets of the same frequencies");
  for (VectorXd& other : std::exchange(others, {})) {
    tried.begin("set");
    if (auto led = record.led_by_lines(other)) others.push_back(std::move(*led));
    tried.count();
  }
  if (others.empty()) return result;
  const std::optional<filters::BatchEstimate> best = record.from(run.unknown_state.mean);
  if (!best) return result;
  const VectorXd here = unknown_values(*run.model, best->state);
  const double prior = distance_to_prior(run, run.unknown_state.mean),
               widened = run.interval_factor * run.interval_factor;
  for (const VectorXd& other : others) {
    tried.begin("set");
    const std::optional<filters::BatchEstimate> fit = record.from(other);
    tried.count();
    // Intervals that hold a scatter of sections are wide in one unknown; a residual half as large again in
    // squares explains a record less, however wide they are.
    constexpr double as_well = 1.5;
    if (!fit || fit->costs.back() > as_well * best->costs.back()) continue;
    RecordTwin twin{unknown_values(*run.model, fit->state),
                    2.0 * (fit->costs.back() - best->costs.back()) / widened,
                    distance_to_prior(run, fit->state(run.model->unknown_places)) - prior};
    const bool known = std::any_of(result.sets.begin(), result.sets.end(), [&](const RecordTwin& one) {
      return !differ(one.values, twin.values, found.places);
    });
    if (twin.chi_square <= as_well_chi_square && differ(twin.values, here, found.places) &&
        is_another(twin.values, run, found.places) && !known)
      result.sets.push_back(std::move(twin));
  }
  std::sort(result.sets.begin(), result.sets.end(),
            [](const RecordTwin& a, const RecordTwin& b) { return a.prior_chi_square < b.prior_chi_square; });
  if (result.sets.empty()) return result;
  std::vector<VectorXd> sets{here(found.places)};
  for (const RecordTwin& twin : result.sets) sets.emplace_back(twin.values(found.places));
  result.deciding = deciding_measurements(*study.model, study.data(), sets, exactly);
  return result;
}

LikeliestSet likeliest_set(const Experiment& experiment, const std::filesystem::path& folder,
                           const std::function<Comparison(const Experiment&)>& identify,
                           const Progress& progress) {
  LikeliestSet result{identify(experiment), {}, {}};
  result.twins = record_twins(experiment, result.found, folder, progress);
  if (const RecordTwin* const better = result.twins.better()) {
    const double less = -better->more();
    const Experiment from_there = started_from(experiment, result.found.runs.front(), *better);
    Comparison again = identify(from_there);
    const ComparedRun &before = result.found.runs.front(), &after = again.runs.front();
    if (after.has_estimate() && (after.answers() || !before.answers())) {
      result.twins = record_twins(from_there, again, folder, progress);
      result.found = std::move(again);
      result.exchanged = fmt::format(
          "The search from the initial estimates ended in a set of parameters with the same frequencies "
          "whose chi^2 is "
          "{:.3g} higher. The estimate is the likelier set.",
          less);
    }
  }
  ComparedRun& run = result.found.runs.front();
  if (result.twins.undecided() > 0) {
    run.object({"not_unique", not_unique_text(result.twins)});
    if (run.answers())
      run.status = ComparedRun::Status::not_unique, run.reason = "other sets explain the record as well";
  }
  return result;
}

}  // namespace beamid::experiments
