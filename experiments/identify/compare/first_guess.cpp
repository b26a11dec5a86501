#include "experiments/identify/compare/first_guess.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/identify/driven/driven_fit.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/signal/decimation.hpp"

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
  const auto fit = fit_driven(*problem);
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

}  // namespace beamid::experiments
