#include "experiments/identify/parts/parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "experiments/identify/engine/compared_run.hpp"
#include "experiments/identify/engine/identified_parameters.hpp"
#include "experiments/identify/engine/low_mode_fit.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/engine/noise_in_estimates.hpp"
#include "experiments/identify/parts/line_likelihood.hpp"
#include "experiments/identify/verdict/run_verdict.hpp"
#include "experiments/models/motion/supported_motion.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

VectorXd noise_inside(const Experiment& experiment, const ComparedRecord& record) {
  const std::vector<Index> outputs = output_channels(record.record);
  VectorXd noise(static_cast<Index>(outputs.size()));
  for (Index i = 0; i < noise.size(); ++i) {
    const Index row = outputs[static_cast<std::size_t>(i)];
    const Channel& channel = record.record.channels[static_cast<std::size_t>(row)];
    noise[i] = stated_noise(experiment, channel);
    if (!(noise[i] > 0.0) && record.sensor_noise.size() > row) noise[i] = record.sensor_noise[row];
    if (!(noise[i] > 0.0))
      throw std::invalid_argument(fmt::format(
          "the noise of '{}', inside a span, is not stated; expected noise in [[record.channels]] or "
          "[noise]",
          channel.name));
  }
  return noise;
}

filters::Gaussian known_of(const JointModel& model) {
  const auto q = static_cast<Index>(model.unknowns.size());
  filters::Gaussian known{VectorXd(q), MatrixXd::Zero(q, q), {}};
  for (Index j = 0; j < q; ++j) {
    const Unknown& unknown = model.unknowns[static_cast<std::size_t>(j)];
    known.mean[j] = unknown.to_state(unknown.guess);
    const double deviation = unknown.deviation / std::abs(unknown.slope(known.mean[j]));
    known.covariance(j, j) = deviation * deviation;
  }
  return known;
}

// The whole state of a model at its unknowns, its motion at rest.
VectorXd state_at(const JointModel& model, const VectorXd& theta) {
  VectorXd state = VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size()));
  state(model.unknown_places) = theta;
  return state;
}

// Away from the truth J has a minimum for every resonance missed: all stiffnesses are moved together first.
std::vector<VectorXd> scaled_starts(const JointModel& model, const filters::Gaussian& known) {
  constexpr int steps = 30;
  constexpr double widest = 3.0;
  std::vector<VectorXd> starts;
  const FirstGuess guess{state_at(model, known.mean), {}};
  for (int i = -steps; i <= steps; ++i) {
    const VectorXd change = scaled_stiffness(model, guess, std::pow(widest, static_cast<double>(i) / steps));
    if (change.size() > 0) starts.emplace_back(known.mean + change);
  }
  return starts;
}

// Of an input that was not measured: a thousand times what it would take to make the motion inside, as good
// as none.
double noise_without_law(const RecordLines& record, const SupportedResponse& response, Index input) {
  constexpr double many = 1e3;
  const double omega = record.omega[record.omega.size() / 2];
  return many * record.outputs.norm() / std::sqrt(static_cast<double>(record.omega.size())) /
         response.transfer(omega).col(input).norm();
}

LineProblem problem_of(const Experiment& experiment, const ComparedRecord& record, const JointModel& model,
                       const std::optional<double>& highest_hz) {
  const auto* const motion = dynamic_cast<const SupportedMotion*>(model.motion.get());
  if (!motion) throw std::invalid_argument("a span without sections; expected from_m or to_m");
  const Record& read = record.record;
  LineProblem problem{
      [&model, motion](const VectorXd& theta) {
        SecondOrderForm form;
        motion->evaluate(state_at(model, theta), form, nullptr);
        return SupportedResponse(form, motion->rows(), motion->supports());
      },
      record_lines(measurements(read), read.samples(input_channels(read), Eigen::all), highest_hz),
      noise_inside(experiment, record),
      input_noise(experiment, read),
      0,
      0,
      known_of(model)};
  const SupportedResponse expected = problem.response(problem.prior.mean);
  const double limit = std::numbers::pi / read.interval();
  problem.free_modes = 1 + (expected.frequencies().array() < limit).count();
  for (Index i = 0; i < problem.input_noise.size(); ++i)
    if (std::isinf(problem.input_noise[i])) {
      problem.input_noise[i] = noise_without_law(problem.record, expected, i);
      ++problem.unmeasured;
    }
  return problem;
}

// What a fit leaves of the record, by its lines where the motion inside is strong against the noise and where
// it is weak, half of them each.
struct LinesLeft {
  double strong = 0.0, weak = 0.0;  // mean of the squares, 1 where the noise is as stated
  double motion_percent = 0.0;      // of the motion inside, what the noise of the weak lines does not explain
  double deviation = 0.0;           // of strong / weak by chance
};

LinesLeft lines_left(const LineProblem& problem, const LineFit& fit) {
  const Index lines = fit.squares.size(), spare = problem.output_noise.size() - problem.unmeasured;
  // By what was read alone: what a fit leaves of a line must not decide where the line counts.
  const MatrixXd read = problem.output_noise.cwiseInverse().asDiagonal() * problem.record.outputs.cwiseAbs();
  const VectorXd power = read.colwise().squaredNorm();
  std::vector<Index> order(static_cast<std::size_t>(lines));
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return power[a] > power[b]; });
  const Index half = lines / 2;
  const VectorXd sorted = fit.squares(order);
  const double each = 1.0 / static_cast<double>(half * spare);
  LinesLeft left{sorted.head(half).sum() * each, sorted.tail(half).sum() * each, 0.0, std::sqrt(2.0 * each)};
  const double share = std::max(0.0, 1.0 - left.weak / left.strong);  // of what is left where it is strong
  left.motion_percent = 100.0 * std::sqrt(share * fit.squares.sum() / fit.readings.sum());
  return left;
}

// A span moves as its sections and E I make it, or something is not as described. What is left where motion
// is strong, beyond what is left where it is weak, is no noise.
void judge_span(const LinesLeft& left, ComparedRun& run) {
  constexpr double many = 4.0, too_much = 2.0, whatever = 10.0;
  constexpr double chance = 4.0;  // deviations of the ratio
  run.misfit_percent = left.motion_percent;
  if (!(left.strong > left.weak * (1.0 + chance * left.deviation))) return;
  const bool stands_out = left.strong > many * left.weak && left.motion_percent > too_much;
  if (!stands_out && !(left.motion_percent > whatever)) {
    run.objections.emplace_back(
        "unexplained",
        fmt::format("The sections do not explain {:.2g} % of the motion inside: lines are {:.3g} "
                    "times the noise stated where motion is strong, {:.3g} times where it is weak. "
                    "Estimates may be off by more than their intervals: a place, a gain, a mass, a force "
                    "inside, or a simulation cut to few modes",
                    left.motion_percent, std::sqrt(left.strong), std::sqrt(left.weak)),
        left.motion_percent, whatever);
    return;
  }
  run.status = ComparedRun::Status::contradicted;
  run.reason = fmt::format(
      "the measured motion of its sections does not make the motion inside: the residual is {:.3g} % of it, "
      "and is no noise. A sensor's place, a sign, a unit or a clock is wrong, a force inside is missing, or "
      "a mass "
      "is not as described",
      left.motion_percent);
  run.object({"unexplained", "CONTRADICTED: " + run.reason + ".", left.motion_percent, too_much});
}

void take_fit(const LineProblem& problem, const LineFit& fit, const std::optional<Experiment>& truth,
              ComparedRun& run) {
  const JointModel& model = *run.model;
  run.unknowns = model.unknowns;
  run.unknown_state = {fit.theta, fit.covariance, {}};
  run.unknown_start = problem.prior;
  filters::Gaussian& whole = run.run.last;
  whole.mean = state_at(model, fit.theta);
  whole.covariance.setZero(whole.mean.size(), whole.mean.size());
  whole.covariance(model.unknown_places, model.unknown_places) = fit.covariance;
  const VectorXd bounds =
      bounds_of_unknowns(fit.information, problem.prior.covariance.diagonal().cwiseSqrt(), model, fit.theta);
  const std::vector<Estimate> found = estimates(model, whole);
  for (std::size_t j = 0; j < found.size(); ++j) {
    ComparedParameter one{found[j], {}, {}};
    if (truth) one.truth = true_value(*truth, 0.0, model.unknowns[j]);
    if (const double bound = bounds[static_cast<Index>(j)]; std::isfinite(bound)) one.bound = bound;
    run.parameters.push_back(one);
  }
  // As whole innovations are judged (parts.cpp).
  filters::InnovationConsistency consistency;
  consistency.mean_normalised_square = 2.0 * fit.squares.sum() / fit.freedom;
  consistency.upper_95 = 1.0 + quantile_95 * std::sqrt(2.0 / fit.freedom);
  run.diagnostics.emplace().consistency = consistency;
}

// A ratio is of the modes of the whole, which a span does not have.
void warn_of_ratios(const fem::DampingLaw& law, ComparedRun& run) {
  if (std::holds_alternative<fem::ModalDamping>(law) || std::holds_alternative<fem::StructuralDamping>(law))
    run.objections.emplace_back(
        "part_law",
        fmt::format(
            "[damping] law = \"{}\" is of the whole beam's modes; those of the span held at its sections "
            "have taken its ratios. Expected rayleigh",
            fem::name(law)));
}

}  // namespace

Comparison identify_span(const Experiment& experiment, ComparedRecord record,
                         const std::optional<double>& highest_hz) {
  Comparison comparison{std::move(record), {}, {}};
  ComparedRun run;
  run.reduction = "none", run.filter = "lines of the spectrum";
  const ModelSetting setting = model_setting(experiment, comparison.compared.record, experiment.reduction);
  run.model = model_registry().make("beam", experiment.model.options, setting);
  run.coordinates = run.model->motion_size();
  warn_of_ratios(experiment.damping, run);
  try {
    const LineProblem problem = problem_of(experiment, comparison.compared, *run.model, highest_hz);
    run.noise = problem.output_noise;
    const LineFit fit = fit_lines(problem, scaled_starts(*run.model, problem.prior));
    take_fit(problem, fit, comparison.compared.truth, run);
    if (fit.converged) {
      judge_span(lines_left(problem, fit), run);
      judge_what_is_said(run);
    } else
      run.status = ComparedRun::Status::diverged, run.reason = "its likelihood has no maximum near the start";
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    run.status = ComparedRun::Status::diverged;
    run.reason = error.what();
  }
  comparison.runs.push_back(std::move(run));
  return comparison;
}

}  // namespace beamid::experiments
