#include "experiments/record_comparison/compared_run.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <chrono>
#include <cmath>
#include <complex>
#include <numbers>

#include "experiments/diagnostics_report.hpp"
#include "experiments/finest_discretisation.hpp"
#include "experiments/identification.hpp"
#include "experiments/modal_analysis/dominant_mode.hpp"
#include "experiments/model_setting.hpp"
#include "experiments/nonlinear_reproduction.hpp"
#include "experiments/record_comparison/true_value.hpp"
#include "experiments/record_inputs.hpp"
#include "experiments/reproduction.hpp"
#include "experiments/start_belief.hpp"
#include "filters/fisher_information.hpp"
#include "filters/identifiability.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Clock = std::chrono::steady_clock;

constexpr double smallest_noise = 1e-6;  // likewise: a record without noise would make P0 / R overflow digits
constexpr double near = 0.05;            // a motion whose frequency is farther off is another motion

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
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
  KnownNoise known{VectorXd::Zero(outputs.rows()), smallest_noise * root_mean_squares(outputs)};
  for (Index i = 0; i < outputs.rows(); ++i) {
    const auto given = context.experiment.noise.find(context.compared.record.channels[channels[i]].quantity);
    if (given != context.experiment.noise.end()) known.configured[i] = given->second;
    if (context.compared.sensor_noise.size() > 0)
      known.least[i] = std::max(known.least[i], context.compared.sensor_noise[channels[i]]);
  }
  return known;
}

// Channels weighed by their size, before anything is known of their noise.
MatrixXd unit_noise(const MatrixXd& outputs) {
  return root_mean_squares(outputs).cwiseMax(1e-300).cwiseAbs2().asDiagonal();
}

VectorXd assumed(const KnownNoise& known, const VectorXd& left) {
  return (known.configured.array() > 0.0).select(known.configured, left.cwiseMax(known.least));
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

void score(ComparedRun& run, const RunContext& context, const JointModel& model, const Reproduction& motion,
           const VectorXd& bound) {
  const std::vector<Estimate> found = estimates(model, run.run.last);
  for (std::size_t j = 0; j < found.size(); ++j) {
    ComparedParameter parameter{found[j], {}, {}};
    if (context.compared.truth) parameter.truth = true_value(*context.compared.truth, model, j);
    if (const double least = bound[static_cast<Index>(j)]; std::isfinite(least)) parameter.bound = least;
    run.parameters.push_back(parameter);
  }
  run.reproduced = motion.outputs;
  run.response_error_percent = motion.response_error_percent;
}

// The lowest frequency at which the model oscillates with these parameters.
std::optional<double> frequency_of(const JointModel& model, const VectorXd& state) {
  const auto* motion = dynamic_cast<const filters::LinearMotion*>(model.motion.get());
  if (!motion) return {};
  MatrixXd rates;
  motion->motion_matrix(state, rates);
  std::optional<double> lowest;
  const Eigen::VectorXcd eigenvalues = Eigen::EigenSolver<MatrixXd>(rates, false).eigenvalues();
  for (const std::complex<double>& lambda : eigenvalues) {
    const double frequency = std::abs(lambda) / (2.0 * std::numbers::pi);
    if (lambda.imag() > 0.0 && frequency < lowest.value_or(1e300)) lowest = frequency;
  }
  return lowest;
}

// The same of a model too large for that, from what it reproduces.
std::optional<double> heard_frequency(const VectorXd& signal, double dt, double expected_hz) {
  try {
    ModalAnalysisSettings settings;
    settings.expected_frequency_hz = expected_hz;
    return dominant_mode(signal, dt, settings).frequency_hz;
  } catch (const std::invalid_argument&) {
    return {};
  }
}

void judge(ComparedRun& run, const RunContext& context, const JointModel& model, double interval) {
  const auto& expected = context.modal_frequency_hz;
  run.frequency_hz = frequency_of(model, run.run.last.mean);
  if (!run.frequency_hz && expected)
    run.frequency_hz = heard_frequency(run.reproduced.row(0), interval, *expected);
  if (!expected || !run.frequency_hz || std::abs(*run.frequency_hz / *expected - 1.0) < near) return;
  run.status = ComparedRun::Status::diverged;
  run.reason = fmt::format("moves at {:.4g} Hz where the record has {:.4g} Hz", *run.frequency_hz, *expected);
}

std::string failure_text(const filters::Failure& failure) {
  return fmt::format("sample {}, {:.4f} s: {}{}", failure.step, failure.time, failure.reason,
                     std::isnan(failure.smallest_eigenvalue)
                         ? ""
                         : fmt::format(" (smallest eigenvalue {:.3g})", failure.smallest_eigenvalue));
}

}  // namespace

ComparedRun run_once(const RunContext& context, const ModelSetting& setting, const StartedModel& started,
                     const RunSettings& settings) {
  const JointModel& model = started.model;
  ComparedRun result;
  const filters::Measurements record = measurements(context.compared.record);
  const double dt = context.compared.record.interval();
  const Index p = record.outputs.rows();
  result.coordinates = model.motion_size();
  result.observed_per_freedom = static_cast<double>(p) / static_cast<double>(result.coordinates);

  if (const auto inputs = record_inputs(context.compared.record);
      inputs && inputs->path == InputPath::held && is_whole_mesh(model)) {
    result.status = ComparedRun::Status::refused;
    result.reason =
        "the modes of a mesh far above the sampling rate do not follow forces that are held, and its "
        "accelerations come out wrong; expected input = \"band_limited\" or \"linear\", or a reduction";
    return result;
  }
  const StartScale scale =
      start_scale(model, setting.observations, record.outputs, dt * static_cast<double>(record.time.size()));
  const StartDirections directions = start_directions(model, setting.observations, scale);
  const KnownNoise known = known_noise(context, record.outputs);
  IdentificationSettings identification{settings.filter.name,
                                        settings.filter.options,
                                        settings.discretisation,
                                        start_belief(model, with_guess(directions, model, started.guess)),
                                        filters::Start::at_first_sample,
                                        {},
                                        1,
                                        context.experiment.on_failure};
  Reproduction motion;
  try {
    const auto hear = [&](const VectorXd& state) {
      const auto discrete = finest(model, dt, unit_noise(record.outputs));
      motion = is_nonlinear(model) ? reproduce_nonlinear(model, *discrete, state, directions, record)
                                   : reproduce(*discrete, state, directions, record);
    };
    Clock::time_point start = Clock::now();
    hear(started.guess.mean);
    result.response_seconds = seconds_since(start);
    for (int pass = 1; pass <= settings.passes; ++pass) {
      identification.initial.mean = motion.initial_state;
      result.noise = assumed(known, motion.residual_deviation);
      identification.output_noise = result.noise.cwiseAbs2().asDiagonal();
      start = Clock::now();
      result.run = filter_record(model, record, identification);
      result.seconds += seconds_since(start);
      result.remarks = result.run.remarks;
      result.diagnostics = diagnostics_of(result.run, identification.initial, model.unknown_places);
      if (result.run.failure) break;
      start = Clock::now();
      hear(next_start(model, identification.initial, result.run.last).mean);
      result.response_seconds += seconds_since(start);
    }
    if (!result.run.failure) {
      result.unknowns = model.unknowns;
      result.unknown_state = of_unknowns(model, result.run.last);
      result.unknown_start = of_unknowns(model, identification.initial);
      start = Clock::now();
      const auto discrete = finest(model, dt, identification.output_noise);
      score(result, context, model, motion, bounds(*discrete, model, motion, directions, record));
      result.response_seconds += seconds_since(start);
    }
  } catch (const std::invalid_argument& error) {  // a scheme or a filter that such a model cannot have
    result.status = ComparedRun::Status::refused;
    result.reason = error.what();
    return result;
  } catch (const std::runtime_error& error) {
    result.status = ComparedRun::Status::diverged;
    result.reason = error.what();
    return result;
  }
  if (result.run.failure) {
    result.status = ComparedRun::Status::diverged;
    result.reason = failure_text(*result.run.failure);
    return result;
  }
  judge(result, context, model, dt);
  return result;
}

}  // namespace beamid::experiments
