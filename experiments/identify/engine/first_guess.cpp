#include "experiments/identify/engine/first_guess.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

#include "experiments/identify/driven/driven_fit.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/verdict/reproduction.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/models/motion/following_motion.hpp"
#include "experiments/models/motion/second_order_motion.hpp"
#include "experiments/models/motion/storey_motion.hpp"
#include "experiments/signal/decimation.hpp"
#include "filters/batch_estimator.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double guess_samples_per_period = 8.0;
constexpr Index fewest_guess_samples = 64;  // samples that are worth a first guess
constexpr double guess_noise = 0.3;      // noise of it, of a channel's root mean square: neighbours leak in
constexpr double level_ratio = 3.0;      // of the rates of successive levels
constexpr double guess_widening = 30.0;  // of the deviations found
constexpr double well_left = 0.25;  // of the variance of guess_noise, where the levels have led somewhere

// Covariance of the unknowns alone.
MatrixXd covariance_of_unknowns(const JointModel& model, const filters::Gaussian& estimate) {
  if (estimate.covariance.size() > 0) return estimate.covariance(model.unknown_places, model.unknown_places);
  const MatrixXd rows = estimate.factor(model.unknown_places, Eigen::all);
  return rows * rows.transpose();
}

// Every `factor`-th sample, low-passed; empty when too few remain.
filters::Measurements decimated(const filters::Measurements& record, Index inputs, double interval,
                                int factor) {
  filters::Measurements coarse;
  if (record.time.size() < (fewest_guess_samples + 10) * factor) return coarse;
  coarse.outputs = decimate_channels(record.outputs, factor);
  coarse.time =
      interval * factor *
      VectorXd::LinSpaced(coarse.outputs.cols(), 0.0, static_cast<double>(coarse.outputs.cols() - 1));
  coarse.inputs = decimated_inputs(record, inputs, factor, coarse.time).columns;
  return coarse;
}

// The guess after a record that holds the low modes only.
LowModeGuess guess_after(const JointModel& model, const std::vector<Observation>& observations,
                         const LowRecord& low, const FirstGuess& guess) {
  LowModeGuess found = fit_low_modes(model, observations, low, guess, guess_noise);
  found.guess.unknowns = guess_covariance(guess.unknowns, found.guess.unknowns);
  return found;
}

}  // namespace

MatrixXd guess_covariance(const MatrixXd& prior, const MatrixXd& found) {
  const MatrixXd wide = guess_widening * guess_widening * found;
  // The product of both densities, P (P + F)^-1 F.
  return prior * (prior + wide).ldlt().solve(wide);
}

StartDirections with_guess(StartDirections directions, const JointModel& model, const FirstGuess& guess) {
  directions.unknowns.setZero();
  directions.unknowns(model.unknown_places, Eigen::all) = root_of(guess.unknowns);
  return directions;
}

std::unique_ptr<filters::DiscreteModel> finest(const JointModel& model, double interval,
                                               const MatrixXd& output_noise) {
  return filters::discretise(model.motion, interval, finest_discretisation(model, interval),
                             {{}, output_noise});
}

FirstGuess own_guess(const JointModel& model, const std::vector<Observation>& observations,
                     const MatrixXd& outputs) {
  const filters::Gaussian known = initial_estimate(
      model, start_directions(model, observations, start_scale(model, observations, outputs, 1.0)));
  return {known.mean, covariance_of_unknowns(model, known)};
}

namespace {

// Of a driven record, by all of its lines; absent where they leave more than a model that fits would.
std::optional<FirstGuess> guess_by_lines(const JointModel& model, const filters::Measurements& record,
                                         const FirstGuess& own) {
  constexpr double lost = 0.6;              // of the lines
  if (model.motion_size() == 1) return {};  // whose own beginning leads as far
  auto problem = driven_problem(model, record, {own.mean(model.unknown_places), own.unknowns, {}});
  if (!problem) return {};
  constexpr int most_draws = 32;  // of 0.1 % of damping, a resonance is a line or two of hundreds
  const auto fit = fit_driven(*problem, most_draws);
  if (!fit || fit->left_share > lost) return {};
  FirstGuess found = own;
  found.mean(model.unknown_places) = fit->theta;
  // What a line takes an input for between its samples is not quite what a filter does: a tenth of what was
  // known beforehand, at least, is open to the filter.
  constexpr double open = 0.1;
  const VectorXd narrow =
                     guess_covariance(own.unknowns, fit->covariance(problem->prior)).diagonal().cwiseSqrt(),
                 known = own.unknowns.diagonal().cwiseSqrt();
  found.unknowns = narrow.cwiseMax(open * known).cwiseMin(known).cwiseAbs2().asDiagonal();
  found.by_lines = true;
  return found;
}

}  // namespace

FirstGuess first_guess(const JointModel& model, const std::vector<Observation>& observations,
                       const filters::Measurements& record, double frequency_hz, bool may_use_lines) {
  const double dt = record.interval();
  const FirstGuess own = own_guess(model, observations, record.outputs);
  if (may_use_lines)
    if (const auto driven = guess_by_lines(model, record, own)) return *driven;
  LowModeGuess found{own, 0.0};
  int levels = 0;
  const auto take = [&](const LowRecord& level) {
    found = guess_after(model, observations, level, found.guess);
    ++levels;
  };
  for (double factor = 1.0 / (guess_samples_per_period * frequency_hz * dt); factor >= 2.0;
       factor /= level_ratio) {
    const int whole = decimation_factor(factor, record.size());
    const filters::Measurements coarse = decimated(record, model.motion->input_size(), dt, whole);
    if (coarse.size() > 0) take({coarse, 0.5 / (whole * dt)});
  }
  if (record.size() < fewest_guess_samples) return found.guess;
  const LowRecord last{beginning(record, std::min(longest_guess, record.size())), 0.5 / dt};
  take(last);
  if (levels == 1 || model.motion->input_size() == 0 || found.square < well_left) return found.guess;
  const LowModeGuess alone = guess_after(model, observations, last, own);
  return alone.square < found.square ? alone.guess : found.guess;
}

namespace {

// The first guess of a nonlinear model.

constexpr Index longest_nonlinear_guess = 4096;  // samples
constexpr double nonlinear_guess_noise = 0.05;   // noise of it, of a channel's root mean square
constexpr double periods = 1.5;                  // that are taken up first
constexpr double far_frequency = 2.0;

// The stiffness of the oscillator at the record's frequency, where it is asked about.
void take_frequency(const JointModel& model, double frequency_hz, VectorXd& state) {
  const double omega = 2.0 * std::numbers::pi * frequency_hz, ratio = omega / model.mode_frequencies[0];
  if (!(ratio < far_frequency && ratio > 1.0 / far_frequency)) return;
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    if (model.unknowns[j].quantity == "stiffness" && !model.unknowns[j].nuisance) try {
        state[model.unknown_places[j]] = model.unknowns[j].to_state(model.equivalent_mass * omega * omega);
      } catch (const std::invalid_argument&) {  // outside its bounds: the guess stays
      }
}

/// Unknowns and motion after the first 4096 samples have been fitted, K from the frequency of the record, the
/// phase from all phases of one cycle (reproduction.hpp), then all unknowns and the start together
/// over parts of the record that double in length. A record that is low-passed and decimated, as linear
/// models hear it first, would be another motion to a nonlinear one.
///
/// As there, what is found bounds what filters start from with 30 times its deviations.
/// @param frequency_hz of the first mode, as the record shows it
/// @returns the guesses themselves where no motion of the model is near the record. Unlike that of linear
/// models, the mean holds the motion too.
FirstGuess nonlinear_guess(const JointModel& model, const std::vector<Observation>& observations,
                           const filters::Measurements& record, double frequency_hz) {
  const filters::Measurements part = beginning(record, std::min(longest_nonlinear_guess, record.size()));
  const Index samples = part.size();
  const StartDirections directions = start_directions(
      model, observations, start_scale(model, observations, part.outputs, part.time[samples - 1]));
  VectorXd state = initial_estimate(model, directions).mean;
  const MatrixXd unknowns = directions.unknowns(model.unknown_places, Eigen::all);
  FirstGuess known{state, unknowns * unknowns.transpose()};
  take_frequency(model, frequency_hz, state);
  const VectorXd size = part.outputs.rowwise().norm() / std::sqrt(static_cast<double>(samples));
  const MatrixXd noise = (nonlinear_guess_noise * size).cwiseMax(1e-300).cwiseAbs2().asDiagonal();
  const auto discrete = finest(model, part.time[samples - 1] / static_cast<double>(samples - 1), noise);

  filters::BatchSettings settings;
  settings.first_samples = samples_in(model, part, periods);
  settings.tolerance = 1e-3;
  const MatrixXd all = directions.all();
  settings.prior_factor = MatrixXd::Zero(all.cols(), all.cols());
  settings.prior_factor.diagonal().tail(directions.unknowns.cols()).setOnes();
  state = nearest_phase(*discrete, state, directions, part, settings.first_samples);
  const filters::BatchEstimate found = filters::estimate_batch(*discrete, state, all, part, settings);
  if (found.status == filters::BatchStatus::failed || found.covariance.size() == 0) return known;
  const MatrixXd covariance =
      unknowns * found.covariance.bottomRightCorner(unknowns.cols(), unknowns.cols()) * unknowns.transpose();
  return {found.state, guess_covariance(known.unknowns, covariance)};
}

constexpr Index most_started_coordinates = 12;  // a low-pass leaves fewer modes than that

// The same questions, guessed at what a state says.
std::vector<ParameterChoice> choices_at(const JointModel& model, const Eigen::VectorXd& state) {
  std::vector<ParameterChoice> choices;
  for (std::size_t j = 0; j < model.unknowns.size(); ++j) {
    const Unknown& unknown = model.unknowns[j];
    ParameterChoice choice{unknown.quantity, unknown.name, unknown.region, unknown.mode};
    choice.guess = unknown.to_physical(state[model.unknown_places[j]]);
    choice.deviation = unknown.deviation;
    choice.form = unknown.form;
    if (std::isfinite(unknown.lower)) choice.lower = unknown.lower;
    if (std::isfinite(unknown.upper)) choice.upper = unknown.upper;
    choice.known = unknown.nuisance;
    choices.push_back(choice);
  }
  return choices;
}

// Constants of one model's state in the places that another has for them.
Eigen::VectorXd carried_over(const JointModel& from, const Eigen::VectorXd& state, const JointModel& to) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Index>(to.motion->state_labels().size()));
  result(to.unknown_places) = state(from.unknown_places);
  for (std::size_t i = 0; i < to.offsets.size(); ++i)
    result[to.offsets[i].place] = state[from.offsets[i].place];
  return result;
}

}  // namespace

StartedModel started_model(JointModel first, const Choice& model, const ModelSetting& setting,
                           const filters::Measurements& record, double frequency_hz) {
  const auto made = [&](const ModelSetting& of) {
    return std::move(*model_registry().make(model.name, model.options, of));
  };
  const Index modes = std::max(most_started_coordinates, first.mode_shapes.cols() + 4);
  const bool mesh = is_whole_mesh(first);
  if (is_nonlinear(first)) {
    FirstGuess guess = nonlinear_guess(first, setting.observations, record, frequency_hz);
    return {std::move(first), std::move(guess)};
  }
  // Few modes that follow can be brought to the frequency of one left out: all that the record may hold are
  // fitted first.
  const bool follows = setting.reduction && setting.reduction->spans_lowest_modes() &&
                       dynamic_cast<const FollowingMotion*>(first.motion.get());
  const bool part = !setting.supports.empty();  // in its own coordinates only
  if (part || (!mesh && !follows && first.motion_size() <= most_started_coordinates) ||
      modes >= setting.system.size() || first.unknowns.front().quantity.empty()) {
    FirstGuess guess = first_guess(first, setting.observations, record, frequency_hz);
    return {std::move(first), std::move(guess)};
  }
  ModelSetting truncated = setting;
  truncated.reduction = reduction::reduction_registry().make(
      "modal_truncation", {{"modes", static_cast<double>(mesh ? modes : most_started_coordinates)}});
  const JointModel small = made(truncated);
  const FirstGuess found = first_guess(small, setting.observations, record, frequency_hz, !mesh);
  if (mesh) {
    ModelSetting nearer = setting;
    nearer.parameters = choices_at(small, found.mean);
    first = made(nearer);
  }
  const Eigen::VectorXd mean = carried_over(small, found.mean, first);
  return {std::move(first), {mean, found.unknowns, found.by_lines}};
}

filters::Gaussian known_about_start(const StartedModel& started, const ModelSetting& setting,
                                    const Eigen::MatrixXd& outputs) {
  return {started.guess.mean(started.model.unknown_places),
          own_guess(started.model, setting.observations, outputs).unknowns,
          {}};
}

JointModel on_basis_at(const Choice& model, const ModelSetting& setting, const JointModel& from,
                       const Eigen::VectorXd& state) {
  const auto* storeys = dynamic_cast<const StoreyMotion*>(from.motion.get());
  const auto* motion = storeys ? static_cast<const SecondOrderMotion*>(&storeys->floors())
                               : dynamic_cast<const ReducedMotion*>(from.motion.get());
  if (!motion || motion->description().properties() == 0) return from;
  ModelSetting there = setting;
  there.parameters = choices_at(from, state);
  try {
    JointModel made = *model_registry().make(model.name, model.options, there);
    if (made.motion_size() != from.motion_size()) return from;
    made.unknowns = from.unknowns;
    return made;
  } catch (const std::invalid_argument&) {  // no such beam
    return from;
  } catch (const std::runtime_error&) {
    return from;
  }
}

}  // namespace beamid::experiments
