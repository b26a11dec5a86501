#include "experiments/identify/compare/compared_run.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <chrono>
#include <cmath>
#include <complex>
#include <numbers>

#include "experiments/identify/compare/true_value.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/identify/nonlinear_reproduction.hpp"
#include "experiments/identify/record_inputs.hpp"
#include "experiments/identify/recorded_frequency.hpp"
#include "experiments/identify/reproduction.hpp"
#include "experiments/identify/run_diagnostics.hpp"
#include "experiments/models/divergence.hpp"
#include "experiments/models/finest_discretisation.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/models/start_belief.hpp"
#include "filters/fisher_information.hpp"
#include "filters/identifiability.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using SteadyClock = std::chrono::steady_clock;

constexpr double settled_move = 1.0;         // move of a last pass, in standard deviations
constexpr double smallest_run_noise = 1e-6;  // a record without noise would make P0 / R overflow digits

double seconds_since(SteadyClock::time_point start) {
  return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

VectorXd root_mean_squares(const MatrixXd& samples) {
  return (samples.rowwise().squaredNorm() / static_cast<double>(samples.cols())).cwiseSqrt();
}

/// What is certain of the noise of the outputs: configured, or the sensor's own.
struct KnownNoise {
  VectorXd configured;  // 0: not configured (p)
  VectorXd least;       // (p)
};

KnownNoise known_noise(const RunContext& context, const MatrixXd& outputs) {
  const std::vector<Index> channels = output_channels(context.compared.record);
  KnownNoise known{VectorXd::Zero(outputs.rows()), smallest_run_noise * root_mean_squares(outputs)};
  for (Index i = 0; i < outputs.rows(); ++i) {
    const auto given = context.experiment.noise.find(context.compared.record.channels[channels[i]].quantity);
    if (given != context.experiment.noise.end()) known.configured[i] = given->second;
    if (context.compared.sensor_noise.size() > 0)
      known.least[i] = std::max(known.least[i], context.compared.sensor_noise[channels[i]]);
  }
  return known;
}

// What was measured: samples filled in are none of it.
filters::Measurements readings(const ComparedRecord& compared) {
  filters::Measurements record = measurements(compared.record);
  const std::vector<Index> channels = output_channels(compared.record);
  if (compared.filled.size() > 0)
    record.outputs = compared.filled(channels, Eigen::all).select(std::nan(""), record.outputs);
  return record;
}

// What a motion leaves of the readings (p).
VectorXd left_of(const MatrixXd& outputs, const MatrixXd& motion) {
  const auto read = outputs.array().isFinite();
  const MatrixXd left = read.select(outputs - motion, 0.0);
  const VectorXd counts = read.cast<double>().rowwise().sum().matrix();
  return left.rowwise().squaredNorm().cwiseQuotient(counts.cwiseMax(1.0)).cwiseSqrt();
}

// Channels weighed by their size, before anything is known of their noise.
MatrixXd unit_noise(const MatrixXd& outputs) {
  return root_mean_squares(outputs).cwiseMax(1e-300).cwiseAbs2().asDiagonal();
}

VectorXd assumed(const KnownNoise& known, const VectorXd& left) {
  return (known.configured.array() > 0.0).select(known.configured, left.cwiseMax(known.least));
}

// Of a simulated record its sensors' own, or what the best motion leaves where that is more than chance; of
// another record what the filter assumes.
VectorXd noise_of_bound(const RunContext& context, const KnownNoise& known, const ComparedRun& run) {
  constexpr double surely = 3.0;  // standard deviations of a root mean square
  if (context.compared.sensor_noise.size() == 0) return run.noise;
  const double scatter = 1.0 / std::sqrt(2.0 * static_cast<double>(context.compared.record.size()));
  return (run.noise_left.array() > (1.0 + surely * scatter) * known.least.array())
      .select(run.noise_left, known.least);
}

/// Deviations of the unknowns [their units] that no unbiased estimate falls below, the start unknown;
/// infinite where the record does not determine them. What is known of nuisance parameters, and of how far a
/// joint has slipped at the start, is information.
VectorXd bounds(filters::DiscreteModel& discrete, const JointModel& model, const Reproduction& motion,
                const StartDirections& directions, const filters::Measurements& record) {
  filters::InformationFactor information = filters::information_factor(
      discrete, motion.initial_state, record.time.size(), directions.all(), record.inputs);
  const Index first = directions.motion.cols(), all = information.unknowns();
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    if (model.unknowns[j].nuisance)
      information.add(MatrixXd::Identity(all, all).row(first + static_cast<Index>(j)));
  const auto slips = static_cast<Index>(model.slips.size());
  for (Index i = first - slips; i < first; ++i) information.add(MatrixXd::Identity(all, all).row(i));
  VectorXd bound =
      filters::determined_combinations(information, VectorXd::Ones(all)).bounds.tail(all - first);
  for (Index j = 0; j < bound.size(); ++j) {
    const Index place = model.unknown_places[j];
    bound[j] *=
        directions.unknowns(place, j) * std::abs(model.unknowns[j].slope(motion.initial_state[place]));
  }
  return bound;
}

double share_read(const MatrixXd& outputs) {
  return outputs.array().isFinite().cast<double>().mean();
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

void score(ComparedRun& run, const RunContext& context, const JointModel& model, double mass,
           const Reproduction& motion, const VectorXd& bound) {
  const std::vector<Estimate> found = estimates(model, run.run.last);
  for (std::size_t j = 0; j < found.size(); ++j) {
    ComparedParameter parameter{found[j], {}, {}};
    if (context.compared.truth)
      parameter.truth = true_value(*context.compared.truth, mass, model.unknowns[j]);
    if (const double least = bound[static_cast<Index>(j)]; std::isfinite(least)) parameter.bound = least;
    run.parameters.push_back(parameter);
  }
  run.reproduced = motion.outputs;
  run.response_error_percent = motion.response_error_percent;
}

// The lowest mode at which the model oscillates with these parameters.
std::optional<FoundMode> lowest_mode(const filters::LinearMotion& motion, const VectorXd& state) {
  MatrixXd rates;
  motion.motion_matrix(state, rates);
  std::optional<FoundMode> lowest;
  const Eigen::VectorXcd eigenvalues = Eigen::EigenSolver<MatrixXd>(rates, false).eigenvalues();
  for (const std::complex<double>& lambda : eigenvalues) {
    const double frequency = std::abs(lambda) / (2.0 * std::numbers::pi);
    if (!(lambda.imag() > 0.0) || (lowest && frequency >= lowest->frequency_hz)) continue;
    lowest = FoundMode{};
    lowest->frequency_hz = frequency;
    lowest->damping_ratio = -lambda.real() / std::abs(lambda);
  }
  return lowest;
}

// Its deviations, to first order.
void add_deviations(const filters::LinearMotion& motion, const VectorXd& state,
                    const filters::Gaussian& unknowns, const std::vector<Index>& places, FoundMode& found) {
  constexpr double part = 0.01;  // of a deviation
  MatrixXd slopes = MatrixXd::Zero(2, unknowns.mean.size());
  for (Index j = 0; j < slopes.cols(); ++j) {
    const double step = part * std::sqrt(unknowns.covariance(j, j));
    VectorXd moved = state;
    moved[places[static_cast<std::size_t>(j)]] += step;
    if (const auto mode = lowest_mode(motion, moved); mode && step > 0.0)
      slopes.col(j) << (mode->frequency_hz - found.frequency_hz) / step,
          (mode->damping_ratio - found.damping_ratio) / step;
  }
  const Eigen::Vector2d variance =
      (slopes * unknowns.covariance * slopes.transpose()).diagonal().cwiseMax(0.0);
  found.frequency_deviation_hz = std::sqrt(variance[0]);
  found.damping_ratio_deviation = std::sqrt(variance[1]);
}

void judge_compared_run(ComparedRun& run, const RunContext& context, const JointModel& model,
                        double interval) {
  const std::optional<double> expected =
      context.modal ? std::optional(context.modal->frequency_hz) : std::nullopt;
  const VectorXd& state = run.run.last.mean;
  FoundMode found;
  if (const auto* motion = dynamic_cast<const filters::LinearMotion*>(model.motion.get())) {
    run.mode = lowest_mode(*motion, state);
    if (run.mode) add_deviations(*motion, state, run.unknown_state, model.unknown_places, *run.mode);
    found = run.mode.value_or(FoundMode{});
  } else {
    if (!expected) return;
    const auto shown = recorded_frequency(run.reproduced.row(0), measurements(context.compared.record).inputs,
                                          interval, *expected);
    if (!shown.value_hz) return;
    found.frequency_hz = *shown.value_hz;
  }
  if (found.frequency_hz > 0.0) run.frequency_hz = found.frequency_hz;
  found.frequency_hz = shown_at(found.frequency_hz, 1.0 / interval);
  run.reason = divergence(found, expected);
  if (!run.reason.empty()) run.status = ComparedRun::Status::diverged;
}

// What the discretisation alone does to the mode that the record shows or, of a run that diverged, to any of
// the model's.
void blame_step(ComparedRun& run, const RunContext& context, const JointModel& model,
                const std::string& scheme, double interval) {
  if (is_nonlinear(model) || !context.modal) return;
  const VectorXd frequencies = model.mode_frequencies / (2.0 * std::numbers::pi);
  const Index modes = run.status == ComparedRun::Status::diverged ? frequencies.size() : 1;
  for (Index i = 0; i < modes && run.step_cause.empty(); ++i) {
    FoundMode mode = *context.modal;
    if (i > 0 || frequencies[0] * interval > 0.5) mode.frequency_hz = frequencies[i];
    run.step_cause = step_too_long(scheme, mode, interval);
  }
}

// The belief after a pass that began at another mean than what is known beforehand: counted once, with the
// mean known. P (P_0)^-1 (before - start) is the difference that a prior's mean makes.
void count_once(const JointModel& model, const filters::Gaussian& start, const VectorXd& before,
                filters::Gaussian& last) {
  const VectorXd moved = before(model.unknown_places) - start.mean(model.unknown_places);
  const VectorXd weighed = of_unknowns(model, start).covariance.ldlt().solve(moved);
  if (!weighed.allFinite()) return;
  if (last.covariance.size() > 0) {
    last.mean += last.covariance(Eigen::all, model.unknown_places) * weighed;
  } else {
    const MatrixXd rows = last.factor(model.unknown_places, Eigen::all);
    last.mean += last.factor * (rows.transpose() * weighed);
  }
}

}  // namespace

double shown_at(double frequency_hz, double sampling_rate_hz) {
  return std::abs(std::remainder(frequency_hz, sampling_rate_hz));
}

ComparedRun run_once(const RunContext& context, const ModelSetting& setting, const StartedModel& started,
                     const RunSettings& settings) {
  ComparedRun result;
  const filters::Measurements record = measurements(context.compared.record);
  const double dt = context.compared.record.interval();
  const filters::Measurements read = readings(context.compared);
  const Index p = record.outputs.rows();
  result.coordinates = started.model.motion_size();
  result.observed_per_freedom = static_cast<double>(p) / static_cast<double>(result.coordinates);
  if (const auto inputs = record_inputs(context.compared.record);
      inputs && inputs->path == InputPath::held && is_whole_mesh(started.model)) {
    result.status = ComparedRun::Status::refused;
    result.reason =
        "the modes of a mesh far above the sampling rate do not follow forces that are held, and its "
        "accelerations come out wrong; expected input = \"band_limited\" or \"linear\", or a reduction";
    return result;
  }
  const KnownNoise known = known_noise(context, record.outputs);
  const VectorXd before = started.guess.mean(started.model.unknown_places);
  JointModel model = started.model;
  StartDirections directions;
  IdentificationSettings identification{settings.filter.name,
                                        settings.filter.options,
                                        settings.discretisation,
                                        {},
                                        filters::Start::at_first_sample,
                                        {},
                                        1,
                                        context.experiment.on_failure};
  Reproduction motion;
  double last_move = 0.0;
  // The model on the basis of a state, what is known of its start, and the motion from there that is nearest
  // to the record, about which to linearise.
  const auto begin_at = [&](const VectorXd& state) {
    model = on_basis_at(context.experiment.model, setting, started.model, state);
    const StartScale scale = start_scale(model, setting.observations, record.outputs,
                                         dt * static_cast<double>(record.time.size()));
    directions = start_directions(model, setting.observations, scale);
    identification.initial = start_belief(model, with_guess(directions, model, started.guess));
    const auto discrete = finest(model, dt, unit_noise(record.outputs));
    motion = is_nonlinear(model) ? reproduce_nonlinear(model, *discrete, state, directions, record)
                                 : reproduce(*discrete, state, directions, record);
    identification.initial.mean = motion.initial_state;
    result.noise_left = context.compared.filled.size() > 0 ? left_of(read.outputs, motion.outputs)
                                                           : motion.residual_deviation;
  };
  try {
    SteadyClock::time_point start = SteadyClock::now();
    begin_at(started.guess.mean);
    result.response_seconds = seconds_since(start);
    for (int pass = 1; pass <= settings.passes; ++pass) {
      result.noise = assumed(known, result.noise_left);
      identification.output_noise = result.noise.cwiseAbs2().asDiagonal();
      start = SteadyClock::now();
      result.run = filter_record(model, read, identification);
      result.seconds += seconds_since(start);
      result.remarks = result.run.remarks;
      result.diagnostics = diagnostics_of(result.run, identification.initial, model.unknown_places);
      if (result.run.failure) break;
      count_once(model, identification.initial, started.guess.mean, result.run.last);
      last_move = move_of(model, identification.initial.mean, result.run.last);
      identification.initial.mean(model.unknown_places) = before;
      result.unknown_state = of_unknowns(model, result.run.last);
      result.unknown_start = of_unknowns(model, identification.initial);
      start = SteadyClock::now();
      begin_at(next_start(model, identification.initial, result.run.last).mean);
      result.response_seconds += seconds_since(start);
    }
    if (!result.run.failure) {
      result.unknowns = model.unknowns;
      if (last_move > settled_move) result.remarks.push_back(unsettled_text(last_move));
      start = SteadyClock::now();
      const MatrixXd noise = noise_of_bound(context, known, result).cwiseAbs2().asDiagonal();
      const auto discrete = finest(model, dt, noise);
      score(result, context, model, settings.true_mass, motion,
            bounds(*discrete, model, motion, directions, record) / std::sqrt(share_read(read.outputs)));
      result.response_seconds += seconds_since(start);
    }
  } catch (const std::invalid_argument& error) {  // a scheme or a filter that such a model cannot have
    result.status = ComparedRun::Status::refused;
    result.reason = error.what();
    return result;
  } catch (const std::runtime_error& error) {
    result.status = ComparedRun::Status::diverged;
    result.reason = error.what();
  }
  if (result.run.failure) {
    result.status = ComparedRun::Status::diverged;
    result.reason = failure_text(*result.run.failure);
  }
  if (result.status == ComparedRun::Status::converged) judge_compared_run(result, context, model, dt);
  blame_step(result, context, model, settings.discretisation, dt);
  return result;
}

}  // namespace beamid::experiments
