#include "experiments/identify/engine/passes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "experiments/identify/engine/identified_parameters.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/verdict/reproduction.hpp"
#include "experiments/identify/verdict/run_verdict.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

filters::Gaussian of_unknowns(const JointModel& model, const filters::Gaussian& estimate) {
  const auto q = static_cast<Index>(model.unknown_places.size());
  filters::Gaussian part{VectorXd(q), MatrixXd(q, q)};
  for (Index i = 0; i < q; ++i) {
    const Index at = model.unknown_places[i];
    part.mean[i] = estimate.mean[at];
    for (Index j = 0; j < q; ++j) {
      const Index other = model.unknown_places[j];
      part.covariance(i, j) = estimate.covariance.size() > 0
                                  ? estimate.covariance(at, other)
                                  : estimate.factor.row(at).dot(estimate.factor.row(other));
    }
  }
  return part;
}

double move_of(const JointModel& model, const VectorXd& from, const filters::Gaussian& to) {
  const filters::Gaussian unknowns = of_unknowns(model, to);
  const VectorXd moved = unknowns.mean - from(model.unknown_places);
  double largest = 0.0;
  for (Index j = 0; j < moved.size(); ++j)
    if (!model.unknowns[static_cast<std::size_t>(j)].nuisance && unknowns.covariance(j, j) > 0.0)
      largest = std::max(largest, std::abs(moved[j]) / std::sqrt(unknowns.covariance(j, j)));
  return largest;
}

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

namespace {

using SteadyClock = std::chrono::steady_clock;

// Channels whose lags are not known yet are not read.
void ignore_clocks(const std::vector<OwnClock>& clocks, MatrixXd& outputs, KnownNoise& known) {
  for (const OwnClock& clock : clocks)
    for (const Index i : clock.outputs) {
      known.configured[i] = std::max(largest_measured(outputs.row(i)), known.configured[i]);
      outputs.row(i).setConstant(std::nan(""));
    }
}

}  // namespace

Passes::Passes(const RunContext& context, const ModelSetting& setting, const StartedModel& started,
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
  run_.settings.input_noise = input_noise(context.experiment, context.analysis.record);
  if (const auto& found = run_.likeliest_input_noise = settings.input_noise; found) {
    run_.settings.input_noise = found->deviation;
    for (Index i = 0; i < found->outputs.size(); ++i)
      if (!known_.is_stated[static_cast<std::size_t>(i)]) known_.configured[i] = found->outputs[i];
  }
  if (context.compared.has_open_clocks()) ignore_clocks(context.compared.clocks, record_.outputs, known_);
}

bool Passes::filter() {
  try {
    for (int pass = 1; pass <= settings_.passes; ++pass)
      if (!filter_once()) return false;
    // `identify` answers: of a record that its model does not make entirely, a filter needs more passes.
    const bool answers = settings_.keep == filters::Keep::all_estimates;
    for (int more = 0; more < settings_.passes; ++more) {
      if (!answers || !is_linear_and_driven() || !(last_move_ > unsettled_move)) break;
      if (!filter_once()) return false;
    }
    return true;
  } catch (const std::runtime_error& error) {  // no motion where a pass has ended
    run_.status = ComparedRun::Status::diverged;
    run_.reason = error.what();
    return false;
  }
}

bool Passes::filter_with_likeliest_noise() {
  const LikeliestNoise found = likeliest_noise(context_.experiment, context_.analysis.record, *run_.model,
                                               run_.settings, run_.run.last);
  known_.configured = found.deviation;
  run_.noise_relative_deviation = found.relative_deviation;
  return filter();
}

void Passes::begin() {
  const SteadyClock::time_point start = SteadyClock::now();
  const bool at_guess = started_.linearised_at.size() == 0;
  begin_at(at_guess ? started_.guess.mean : started_.linearised_at);
  run_.response_seconds += seconds_since(start);
  if (context_.experiment.estimator != "filter" && settings_.keep == filters::Keep::all_estimates)
    first_start_ = motion_.initial_state;
}

void Passes::follow_common_clock() {
  begin_at(started_.guess.mean);
  run_.reproduced = motion_.outputs;
}

// One linear mode: a scheme sees K and C of its own in a record, with which the exact motion misses it.
bool Passes::nearest_with_own_scheme() const {
  return run_.coordinates == 1 && !is_nonlinear(*run_.model);
}

// With which motions are held against the record. @param noise covariance of the outputs (p x p)
std::unique_ptr<filters::DiscreteModel> Passes::discretised(const MatrixXd& noise) const {
  const JointModel& model = *run_.model;
  return nearest_with_own_scheme()
             ? filters::discretise(model.motion, dt_, settings_.discretisation, {{}, noise})
             : finest(model, dt_, noise);
}

bool Passes::has_settled() const {
  return !(last_move_ > settled_move);
}

// What one mode leaves of the record, of a model that has no more: known without a discretisation.
const VectorXd& Passes::noise_shown() const {
  const VectorXd& of_mode = context_.analysis.mode_noise;
  return nearest_with_own_scheme() && of_mode.size() > 0 ? of_mode : run_.noise_left;
}

// What a pass begins with of the unknowns: as uncertain of what the one before found as to weigh nothing,
// 1 / 30^2, but no more: with the first guess's deviations a filter is linearised anew wherever the noise
// of the first samples takes K and C, and ends up to a deviation from the maximum of the likelihood.
FirstGuess Passes::working_guess() const {
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
void Passes::begin_at(const VectorXd& state) {
  *run_.model = on_basis_at(context_.experiment.model, setting_, started_.model, state);
  const JointModel& model = *run_.model;
  const StartScale scale = start_scale(model, setting_.observations, record_.outputs,
                                       dt_ * static_cast<double>(record_.time.size()));
  directions_ = start_directions(model, setting_.observations, scale);
  next_ = initial_estimate(model, with_guess(directions_, model, working_guess()));
  const auto discrete = discretised(unit_noise(record_.outputs));
  motion_ = is_nonlinear(model) ? reproduce_nonlinear(model, *discrete, state, directions_, record_)
                                : reproduce(*discrete, state, directions_, record_);
  next_.mean = motion_.initial_state;
  run_.noise_left = motion_.residual_deviation;
}

bool Passes::filter_once() {
  context_.progress(fmt::format("pass {} of the filter over {} samples", ++begun_, record_.size()));
  const JointModel& model = *run_.model;
  run_.settings.initial = next_;
  run_.noise = assumed_noise(known_, noise_shown());
  run_.settings.output_noise = run_.noise.cwiseAbs2().asDiagonal();
  SteadyClock::time_point start = SteadyClock::now();
  // A smoother needs every estimate; the figure of an oscillator's K and C their history.
  const bool smoothed = !context_.experiment.smoother.empty();
  const bool drawn = settings_.keep == filters::Keep::all_estimates && is_oscillator(model);
  run_.run = filter_record(
      model, record_, run_.settings, smoothed ? settings_.keep : filters::Keep::last_estimate,
      drawn ? filters::Trace{{model.unknown_places[0], model.unknown_places[1]}} : filters::Trace{});
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

}  // namespace beamid::experiments
