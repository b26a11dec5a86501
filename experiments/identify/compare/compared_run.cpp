#include "experiments/identify/compare/compared_run.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <chrono>
#include <cmath>
#include <numbers>

#include "experiments/identify/compare/run_bound.hpp"
#include "experiments/identify/compare/run_mode.hpp"
#include "experiments/identify/compare/run_noise.hpp"
#include "experiments/identify/compare/true_value.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/identify/noise_source.hpp"
#include "experiments/identify/nonlinear_reproduction.hpp"
#include "experiments/identify/record_inputs.hpp"
#include "experiments/identify/recorded_frequency.hpp"
#include "experiments/identify/reproduction.hpp"
#include "experiments/identify/run_diagnostics.hpp"
#include "experiments/models/finest_discretisation.hpp"
#include "experiments/models/start_belief.hpp"
#include "filters/smoother.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using SteadyClock = std::chrono::steady_clock;
using Status = ComparedRun::Status;

constexpr double settled_move = 1.0;  // of a last pass, in standard deviations

double seconds_since(SteadyClock::time_point start) {
  return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

// Of the unknowns alone, as the state carries them.
filters::Gaussian of_unknowns(const JointModel& model, const filters::Gaussian& belief) {
  const auto q = static_cast<Index>(model.unknown_places.size());
  filters::Gaussian part{VectorXd(q), MatrixXd(q, q)};
  for (Index i = 0; i < q; ++i) {
    const Index at = model.unknown_places[i];
    part.mean[i] = belief.mean[at];
    for (Index j = 0; j < q; ++j) {
      const Index other = model.unknown_places[j];
      part.covariance(i, j) = belief.covariance.size() > 0
                                  ? belief.covariance(at, other)
                                  : belief.factor.row(at).dot(belief.factor.row(other));
    }
  }
  return part;
}

// How far the unknown that moved most is from where it was linearised, in standard deviations.
double move_of(const JointModel& model, const VectorXd& from, const filters::Gaussian& to) {
  const filters::Gaussian unknowns = of_unknowns(model, to);
  const VectorXd moved = unknowns.mean - from(model.unknown_places);
  double largest = 0.0;
  for (Index j = 0; j < moved.size(); ++j)
    if (!model.unknowns[static_cast<std::size_t>(j)].nuisance && unknowns.covariance(j, j) > 0.0)
      largest = std::max(largest, std::abs(moved[j]) / std::sqrt(unknowns.covariance(j, j)));
  return largest;
}

std::string unsettled_text(double moved) {
  return fmt::format(
      "Not settled: its last pass moved an unknown by {:.2g} standard deviations. More passes ([compare] "
      "passes) "
      "or nearer initial estimates are needed.",
      moved);
}

// A pass begins at another mean than what is known beforehand, and surer of it (P_w, at m_w = `start.mean`).
// What is known (P_0, at m_0) takes the place of that, once, in the unknowns U of the estimate (P, m) behind
// it:
//
//     D = P_0^-1 - P_w^-1,   P' = P - P U D (I + U^T P U D)^-1 U^T P,
//     m' = m + P' U (P_0^-1 m_0 - P_w^-1 m_w - D U^T m)
//
// A covariance kept as a factor has P_w = P_0, and its mean alone moves.
void take_known_prior(const JointModel& model, const filters::Gaussian& start, const FirstGuess& known,
                      const VectorXd& known_mean, filters::Gaussian& last) {
  const auto& places = model.unknown_places;
  const VectorXd first = start.mean(places);
  if (last.covariance.size() == 0) {
    const VectorXd weighed = known.unknowns.ldlt().solve(known_mean - first);
    if (!weighed.allFinite()) return;
    const MatrixXd rows = last.factor(places, Eigen::all);
    last.mean += last.factor * (rows.transpose() * weighed);
    return;
  }
  const auto q = static_cast<Index>(places.size());
  const MatrixXd before = known.unknowns.inverse(), working = of_unknowns(model, start).covariance.inverse(),
                 change = before - working;
  const MatrixXd columns = last.covariance(Eigen::all, places), block = columns(places, Eigen::all);
  const MatrixXd less =
      columns * change * (MatrixXd::Identity(q, q) + block * change).inverse() * columns.transpose();
  if (!less.allFinite()) return;
  const VectorXd pull = before * known_mean - working * first - change * last.mean(places);
  last.covariance -= 0.5 * (less + less.transpose());
  last.mean += last.covariance(Eigen::all, places) * pull;
  last.factor.resize(0, 0);
}

// What the discretisation alone does to the mode that the record shows or, of a run that diverged, to any of
// the model's.
std::string cause_in_step(const ComparedRun& run, const std::optional<FoundMode>& shown,
                          const std::string& scheme, double interval) {
  if (is_nonlinear(*run.model) || !shown) return {};
  const VectorXd frequencies = run.model->mode_frequencies / (2.0 * std::numbers::pi);
  const Index modes = run.status == Status::diverged ? frequencies.size() : 1;
  for (Index i = 0; i < modes; ++i) {
    FoundMode mode = *shown;
    if (i > 0 || frequencies[0] * interval > 0.5) mode.frequency_hz = frequencies[i];
    if (const std::string cause = step_too_long(scheme, mode, interval); !cause.empty()) return cause;
  }
  return {};
}

/// The passes of one run.
class Passes {
 public:
  Passes(const RunContext& context, const ModelSetting& setting, const StartedModel& started,
         const RunSettings& settings)
      : context_(context),
        setting_(setting),
        started_(started),
        settings_(settings),
        record_(measurements(context.analysis.record)),
        dt_(context.analysis.record.interval()),
        known_(known_noise(context.experiment, context.analysis, context.compared)) {
    run_.model = std::make_shared<JointModel>(started.model);
    run_.coordinates = started.model.motion_size();
    run_.observed_per_freedom =
        static_cast<double>(record_.outputs.rows()) / static_cast<double>(run_.coordinates);
    run_.noise_is_stated = known_.is_stated;
    run_.settings.filter = settings.filter.name;
    run_.settings.filter_options = settings.filter.options;
    run_.settings.discretisation = settings.discretisation;
    run_.settings.on_failure = context.experiment.on_failure;
  }

  ComparedRun& run() { return run_; }

  /// Whether the filter took in the whole record.
  bool filter() {
    for (int pass = 1; pass <= settings_.passes; ++pass)
      if (!filter_once()) return false;
    return true;
  }

  /// Noise levels by the filter's likelihood, and all passes again with them.
  bool filter_with_likeliest_noise() {
    const LikeliestNoise found = likeliest_noise(context_.experiment, context_.analysis.record, *run_.model,
                                                 run_.settings, run_.run.last);
    known_.configured = found.deviation;
    run_.noise_relative_deviation = found.relative_deviation;
    return filter();
  }

  void begin() {
    const SteadyClock::time_point start = SteadyClock::now();
    const bool at_guess = started_.linearised_at.size() == 0;
    begin_at(at_guess ? started_.guess.mean : started_.linearised_at);
    run_.response_seconds += seconds_since(start);
    if (context_.experiment.estimator != "filter" && settings_.keep == filters::Keep::all_beliefs)
      first_start_ = motion_.initial_state;
  }

  /// Estimates, the motion that they make of the record, their bounds; what else was asked for.
  void finish() {
    const SteadyClock::time_point start = SteadyClock::now();
    run_.unknowns = run_.model->unknowns;
    if (last_move_ > settled_move) run_.remarks.push_back(unsettled_text(last_move_));
    const MatrixXd noise =
        noise_of_bound(context_.compared, known_, run_.noise_left, run_.noise).cwiseAbs2().asDiagonal();
    const auto discrete = finest(*run_.model, dt_, noise);
    if (nearest_with_own_scheme())
      motion_ = reproduce(*discrete, motion_.initial_state, directions_, record_);
    score(run_bounds(*discrete, *run_.model, motion_.initial_state, directions_, record_));
    if (!nearest_with_own_scheme() || !context_.analysis.modal) weigh_noise();
    run_.response_seconds += seconds_since(start);
    if (settings_.keep == filters::Keep::last_belief) return;
    if (first_start_.size() > 0)
      run_.batch = identify_batch(*run_.model, run_.settings, first_start_, directions_.all(), record_);
    if (!context_.experiment.smoother.empty()) {
      const auto filtered = filters::discretise(run_.model->motion, dt_, run_.settings.discretisation,
                                                {{}, run_.settings.output_noise});
      run_.smoothed = filters::smooth(run_.run, *filtered, record_, context_.experiment.smoother).beliefs;
    }
  }

  void judge_motion() {
    const auto& shown = context_.analysis.mode;
    const VectorXd& state = run_.run.last.mean;
    run_.mode = lowest_mode(*run_.model, state, run_.unknown_state);
    FoundMode found = run_.mode.value_or(FoundMode{});
    if (!dynamic_cast<const filters::LinearMotion*>(run_.model->motion.get())) {
      if (!shown) return;
      const auto of_motion =
          recorded_frequency(run_.reproduced.row(0), record_.inputs, dt_, shown->frequency_hz);
      if (!of_motion.value_hz) return;
      found.frequency_hz = *of_motion.value_hz;
    }
    if (found.frequency_hz > 0.0) run_.frequency_hz = found.frequency_hz;
    found.frequency_hz = shown_at(found.frequency_hz, 1.0 / dt_);
    run_.reason = divergence(found, shown ? std::optional(shown->frequency_hz) : std::nullopt);
    if (!run_.reason.empty()) run_.status = Status::diverged;
  }

 private:
  // One linear mode: a scheme sees K and C of its own in a record, with which the exact motion misses it.
  bool nearest_with_own_scheme() const { return run_.coordinates == 1 && !is_nonlinear(*run_.model); }

  // What one mode leaves of the record, of a model that has no more: known without a discretisation.
  const VectorXd& noise_shown() const {
    const VectorXd& of_mode = context_.analysis.mode_noise;
    return nearest_with_own_scheme() && of_mode.size() > 0 ? of_mode : run_.noise_left;
  }

  // What a pass begins with of the unknowns: as uncertain of what the one before found as to weigh nothing,
  // 1 / 30^2, but no more: with the first guess's deviations a filter is linearised anew wherever the noise
  // of the first samples takes K and C, and ends up to a deviation from the maximum of the likelihood.
  FirstGuess working_guess() const {
    constexpr double weighs_nothing = 30.0;
    FirstGuess guess = started_.guess;
    if (run_.unknown_state.covariance.size() == 0 || run_.run.last.covariance.size() == 0) return guess;
    const VectorXd found = run_.unknown_state.covariance.diagonal().cwiseSqrt(),
                   known = guess.unknowns.diagonal().cwiseSqrt();
    const VectorXd share = (weighs_nothing * found.array() / known.array().max(1e-300)).min(1.0);
    if (!share.allFinite()) return guess;
    guess.unknowns = share.asDiagonal() * guess.unknowns * share.asDiagonal();
    return guess;
  }

  // The model on the basis of a state, what is known of its start, and the motion from there that is nearest
  // to the record, about which to linearise.
  void begin_at(const VectorXd& state) {
    *run_.model = on_basis_at(context_.experiment.model, setting_, started_.model, state);
    const JointModel& model = *run_.model;
    const StartScale scale = start_scale(model, setting_.observations, record_.outputs,
                                         dt_ * static_cast<double>(record_.time.size()));
    directions_ = start_directions(model, setting_.observations, scale);
    next_ = start_belief(model, with_guess(directions_, model, working_guess()));
    const MatrixXd unit = unit_noise(record_.outputs);
    const auto discrete = nearest_with_own_scheme()
                              ? filters::discretise(model.motion, dt_, settings_.discretisation, {{}, unit})
                              : finest(model, dt_, unit);
    motion_ = is_nonlinear(model) ? reproduce_nonlinear(model, *discrete, state, directions_, record_)
                                  : reproduce(*discrete, state, directions_, record_);
    next_.mean = motion_.initial_state;
    run_.noise_left = motion_.residual_deviation;
  }

  // Where no one mode says what of the noise counts.
  void weigh_noise() {
    constexpr Index most_numbers = 20'000'000;
    const Index columns = directions_.motion.cols() + directions_.unknowns.cols();
    if (record_.outputs.size() * columns > most_numbers) return;
    const auto discrete = finest(*run_.model, dt_, run_.settings.output_noise);
    run_.noise_in = noise_in_estimates(*discrete, motion_.initial_state, directions_, record_,
                                       record_.outputs - motion_.outputs);
  }

  bool filter_once() {
    const JointModel& model = *run_.model;
    run_.settings.initial = next_;
    run_.noise = assumed_noise(known_, noise_shown());
    run_.settings.output_noise = run_.noise.cwiseAbs2().asDiagonal();
    SteadyClock::time_point start = SteadyClock::now();
    run_.run = filter_record(model, record_, run_.settings, settings_.keep);
    run_.seconds += seconds_since(start);
    run_.remarks = run_.run.remarks;
    filters::Gaussian& initial = run_.settings.initial;
    run_.diagnostics = diagnostics_of(run_.run, initial, model.unknown_places);
    if (run_.run.failure) return false;
    const VectorXd known_mean = started_.guess.mean(started_.model.unknown_places);
    take_known_prior(model, initial, started_.guess, known_mean, run_.run.last);
    last_move_ = move_of(model, initial.mean, run_.run.last);
    run_.unknown_state = of_unknowns(model, run_.run.last);
    run_.unknown_start = {known_mean, started_.guess.unknowns};
    start = SteadyClock::now();
    begin_at(next_start(model, initial, run_.run.last).mean);
    run_.response_seconds += seconds_since(start);
    return true;
  }

  void score(const VectorXd& bound) {
    const std::vector<Estimate> found = estimates(*run_.model, run_.run.last);
    for (std::size_t j = 0; j < found.size(); ++j) {
      ComparedParameter parameter{found[j], {}, {}};
      if (context_.compared.truth)
        parameter.truth = true_value(*context_.compared.truth, settings_.true_mass, run_.model->unknowns[j]);
      if (const double least = bound[static_cast<Index>(j)]; std::isfinite(least)) parameter.bound = least;
      run_.parameters.push_back(parameter);
    }
    run_.reproduced = motion_.outputs;
    run_.response_error_percent = motion_.response_error_percent;
  }

  const RunContext& context_;
  const ModelSetting& setting_;
  const StartedModel& started_;
  const RunSettings& settings_;
  const filters::Measurements record_;
  const double dt_;
  KnownNoise known_;
  ComparedRun run_;
  StartDirections directions_;
  Reproduction motion_;
  filters::Gaussian next_;  // initial estimate of the pass to come
  VectorXd first_start_;    // of the first pass, where a batch estimate is asked for
  double last_move_ = 0.0;
};

bool would_not_follow_held_forces(const RunContext& context, const JointModel& model) {
  const auto inputs = record_inputs(context.analysis.record);
  return inputs && inputs->path == InputPath::held && is_whole_mesh(model);
}

}  // namespace

ComparedRun run_once(const RunContext& context, const ModelSetting& setting, const StartedModel& started,
                     const RunSettings& settings) {
  Passes passes(context, setting, started, settings);
  ComparedRun& run = passes.run();
  const auto refuse = [&](const std::string& reason) {
    run.status = Status::refused;
    run.reason = reason;
    return run;
  };
  if (would_not_follow_held_forces(context, started.model))
    return refuse(
        "the modes of a mesh far above the sampling rate do not follow forces that are held, and its "
        "accelerations come out wrong; expected input = \"band_limited\" or \"linear\", or a reduction");
  try {
    passes.begin();
    bool whole = passes.filter();
    if (whole && context.experiment.noise_method.name == "likelihood")
      whole = passes.filter_with_likeliest_noise();
    if (whole) passes.finish();
  } catch (const std::invalid_argument& error) {  // a scheme or a filter that such a model cannot have
    run.refused_at = settings.filter.place;
    return refuse(error.what());
  } catch (const std::runtime_error& error) {
    run.status = Status::diverged;
    run.reason = error.what();
  }
  if (run.run.failure) {
    run.status = Status::diverged;
    run.reason = failure_text(*run.run.failure);
  }
  if (run.status == Status::converged) passes.judge_motion();
  run.step_cause =
      cause_in_step(run, context.analysis.mode, settings.discretisation, context.analysis.record.interval());
  return run;
}

}  // namespace beamid::experiments
