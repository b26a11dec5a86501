#include "experiments/identify/compare/passes.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/identify/compare/known_prior.hpp"
#include "experiments/identify/compare/run_verdict.hpp"
#include "experiments/identify/noise_source.hpp"
#include "experiments/identify/nonlinear_reproduction.hpp"
#include "experiments/identify/run_diagnostics.hpp"
#include "experiments/models/finest_discretisation.hpp"
#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
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
  if (context.compared.has_open_clocks()) ignore_clocks(context.compared.clocks, record_.outputs, known_);
}

bool Passes::filter() {
  try {
    for (int pass = 1; pass <= settings_.passes; ++pass)
      if (!filter_once()) return false;
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

// A smoother needs the estimates at all samples; 16 n (n + 1) bytes a sample are kept for nothing else.
filters::Keep Passes::kept_estimates() const {
  return context_.experiment.smoother.empty() ? filters::Keep::last_estimate : settings_.keep;
}

// K and C of one oscillator, for the figure of their convergence.
filters::Trace Passes::traced_states() const {
  if (settings_.keep != filters::Keep::all_estimates || !is_oscillator(*run_.model)) return {};
  return {run_.model->unknown_places};
}

bool Passes::filter_once() {
  const JointModel& model = *run_.model;
  run_.settings.initial = next_;
  run_.noise = assumed_noise(known_, noise_shown());
  run_.settings.output_noise = run_.noise.cwiseAbs2().asDiagonal();
  SteadyClock::time_point start = SteadyClock::now();
  run_.run = filter_record(model, record_, run_.settings, kept_estimates(), traced_states());
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
