#include "experiments/record_identification/record_identification.hpp"
#include "experiments/preparation/analysable_record.hpp"

#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "experiments/channel_places.hpp"
#include "experiments/diagnostics_report.hpp"
#include "experiments/input/method_choice.hpp"
#include "experiments/modal_analysis/shape_fit.hpp"
#include "experiments/model_setting.hpp"
#include "experiments/record_identification/batch.hpp"
#include "experiments/record_identification/noise_source.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "filters/smoother.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr int passes = 2;                     // the first guess may be 20 % off; another one follows
constexpr double last_doubt = 30;             // deviations of K and C told, with which the last pass begins
constexpr double stiffness_doubt = 0.3;       // standard deviation of K0, relative: clamps are never ideal
constexpr double first_damping_ratio = 0.01;  // of C0, with a standard deviation as large
// Smallest noise taken from a record, relative to its largest reading. One simulated without noise would else
// make P0 and R differ by more digits than double precision has.
constexpr double smallest_noise = 1e-6;

// Largest displacement [m] at frequency w [rad/s] behind a channel's largest reading.
double displacement_scale(const Record& record, double w) {
  const double largest = record.samples.row(0).cwiseAbs().maxCoeff();
  switch (record.channels[0].quantity) {
    case Quantity::displacement:
      return largest;
    case Quantity::velocity:
      return largest / w;
    default:
      return largest / (w * w);
  }
}

// At rest give or take the record's own amplitude; K0 and C0 from the beam unless the experiment says
// otherwise.
filters::Gaussian initial_belief(const Experiment& experiment, const Record& record, const JointModel& model,
                                 double beam_stiffness) {
  const PriorBelief& prior = experiment.prior;
  const double mass = model.equivalent_mass, stiffness = prior.stiffness.value_or(beam_stiffness);
  const double w = std::sqrt(stiffness / mass), amplitude = displacement_scale(record, w);
  const double ratio = prior.damping_ratio.value_or(first_damping_ratio),
               to_damping = 2.0 * std::sqrt(stiffness * mass);
  const std::map<std::string, std::pair<double, double>> beliefs{
      {"displacement", {0.0, amplitude}},
      {"velocity", {0.0, amplitude * w}},
      {"stiffness", {stiffness, prior.stiffness_deviation.value_or(stiffness_doubt * stiffness)}},
      {"damping", {ratio * to_damping, prior.damping_ratio_deviation.value_or(ratio) * to_damping}},
      {"sensor_bias", {0.0, 0.1 * amplitude * w * w}}};
  const auto labels = model.motion->state_labels();
  const auto n = static_cast<Index>(labels.size());
  filters::Gaussian belief{VectorXd(n), Eigen::MatrixXd::Zero(n, n)};
  for (Index i = 0; i < n; ++i) {
    const auto& [mean, deviation] = beliefs.at(labels[i].name);
    belief.mean[i] = mean;
    belief.covariance(i, i) = deviation * deviation;
  }
  return belief;
}

double expected_frequency_hz(const Experiment& experiment, const RecordIdentification& known) {
  if (!experiment.prior.stiffness) return known.beam_frequency_hz;
  return Oscillator{known.model.equivalent_mass, *experiment.prior.stiffness}.frequency_hz();
}

// The mode near the frequency that the beam, or the stiffness believed beforehand, leads to expect.
ModalEstimate analyse(const Experiment& experiment, const Record& record, const RecordIdentification& known) {
  ModalAnalysisSettings settings;
  settings.expected_frequency_hz = expected_frequency_hz(experiment, known);
  try {
    return dominant_mode(record.samples.row(0).transpose(), record.interval(), settings);
  } catch (const std::invalid_argument& error) {
    std::ostringstream message;
    message << "modal analysis: " << error.what() << " (looked for near the "
            << *settings.expected_frequency_hz
            << (experiment.prior.stiffness ? " Hz of prior.stiffness_n_per_m"
                                           : " Hz of the beam as described; "
                                             "prior.stiffness_n_per_m tells better")
            << ")";
    throw std::invalid_argument(message.str());
  }
}

// Another pass. K and C are as uncertain at its start as to weigh nothing, 1 / 30^2, but no more: with the
// first belief's doubt a filter is linearised anew wherever the noise of the first samples takes K and C, and
// ends up to a deviation from the maximum of the likelihood.
void refine(RecordIdentification& found, const filters::Measurements& measured) {
  IdentificationSettings settings = found.settings;
  settings.initial = next_start(found.model, settings.initial, found.identification.run.last);
  settings.passes = 1;
  const VectorXd told = last_doubt * found.identification.run.last.deviations();
  for (const Index i : found.model.unknown_places)
    settings.initial.covariance(i, i) = std::min(settings.initial.covariance(i, i), told[i] * told[i]);
  found.last_start = settings.initial;
  found.identification = identify(found.model, measured, settings, filters::Keep::all_beliefs);
}

// The free decay e^(s t) that fits best, at the record's own stamps.
Eigen::MatrixXd reproduced(const Record& record, std::complex<double> rate) {
  const Record even = analysable(record).record;
  const ShapeFit fit = fit_shapes(even.samples, even.interval(), {rate, 0.0}, {true, false});
  Eigen::MatrixXd decay(record.samples.rows(), record.size());
  for (Index k = 0; k < record.size(); ++k)
    decay.col(k) =
        (fit.shapes.col(0) * std::exp(rate * (record.time[k] - even.time[0])) + fit.shapes.col(1)).real();
  return decay;
}

// Deviations of the readings that are there from that decay (p).
VectorXd left_of_readings(const Record& record, std::complex<double> rate) {
  const Eigen::ArrayXXd left = record.samples - reproduced(record, rate);
  constexpr double fitted = 5;
  return (left.isFinite().select(left, 0).square().rowwise().sum() /
          (left.isFinite().cast<double>().rowwise().sum() - fitted).max(1))
      .sqrt();
}

// What the whole record says of every sample, by the model that the last pass was made with.
std::vector<filters::Gaussian> smoothed(const Experiment& experiment, const RecordIdentification& found,
                                        const filters::Measurements& measured) {
  const auto& settings = found.settings;
  const auto discrete = filters::discretise(found.model.motion, measured.interval(), settings.discretisation,
                                            {{}, settings.output_noise});
  return filters::smooth(found.identification.run, *discrete, measured, experiment.smoother).beliefs;
}

// What intervals are to be multiplied by: the noise near the mode counts, whatever R says of all of it. A
// stated R is a claim of the user's, which a record may weaken but not strengthen.
double widening(const RecordIdentification& found) {
  const double factor = found.near_mode.student() * found.near_mode.deviation / found.noise_deviation[0];
  return found.noise_from_record[0] && factor > 0.0 ? factor : std::max(1.0, factor);
}

void take_quiet_noise(const Eigen::VectorXd& quiet_noise, const Record& record, RecordIdentification& found) {
  if (quiet_noise.size() != found.noise_deviation.size())
    throw std::invalid_argument("noise.method is before_event; expected the noise of " +
                                std::to_string(found.noise_deviation.size()) + " channels before the event");
  const VectorXd least = smallest_noise * analysable(record).record.samples.cwiseAbs().rowwise().maxCoeff();
  for (Index i = 0; i < quiet_noise.size(); ++i)
    if (found.noise_from_record[i]) found.noise_deviation[i] = std::max(quiet_noise[i], least[i]);
  found.settings.output_noise = found.noise_deviation.cwiseAbs2().asDiagonal();
  found.interval_factor = widening(found);
}

// The model, the beam's frequency, and what the model is made of: every channel read where it sits.
reduction::ReducedModel take_model(const Experiment& experiment, const Record& record,
                                   RecordIdentification& result) {
  ModelSetting setting = model_setting(experiment, with_places(record, experiment), experiment.reduction);
  if (!setting.forces.empty())
    throw std::invalid_argument(
        "a free decay observes displacement, velocity or acceleration; found a channel of force");
  setting.damping = {};  // the prior is made here
  setting.parameters.clear();
  result.beam_frequency_hz = fem::modes(setting.system, 1).frequency_hz()[0];
  result.model = at_place(experiment.model.place, [&] {
    return *model_registry().make(experiment.model.name, experiment.model.options, setting);
  });
  return reduced(setting);
}

}  // namespace

double expected_frequency_hz(const Experiment& experiment, const Record& record) {
  RecordIdentification known;
  take_model(experiment, record, known);
  return expected_frequency_hz(experiment, known);
}

RecordIdentification prepare_identification(const Experiment& experiment, const Record& record) {
  RecordIdentification result;
  const reduction::ReducedModel reduced = take_model(experiment, record, result);

  const AnalysableRecord even = analysable(record);
  const double dt = even.record.interval();
  result.modal = analyse(experiment, even.record, result);

  const std::complex<double> rate = result.modal.rate();
  const VectorXd left =
      even.remark.empty()
          ? fit_shapes(record.samples, dt, {rate, 0.0}, {true, false}).residual_standard_deviation
          : left_of_readings(record, rate);
  result.noise_deviation =
      left.cwiseMax(smallest_noise * even.record.samples.cwiseAbs().rowwise().maxCoeff());
  result.noise_from_record.assign(record.channels.size(), true);
  for (Index i = 0; i < record.samples.rows(); ++i)
    if (const auto given = experiment.noise.find(record.channels[i].quantity);
        given != experiment.noise.end()) {
      result.noise_deviation[i] = given->second;
      result.noise_from_record[i] = false;
    }
  result.near_mode = noise_near_mode(even.record.samples.row(0).transpose(), dt, result.modal);
  // Of one reading: what is filled in has no noise of its own, and an even grid may be denser than they are.
  result.near_mode.deviation /= std::sqrt(even.share * even.density);
  result.interval_factor = widening(result);

  const double beam_stiffness =
      result.model.equivalent_mass * std::pow(fem::modes(reduced.system, 1).angular_frequency[0], 2);
  result.settings.filter = experiment.filter.name;
  result.settings.filter_options = experiment.filter.options;
  result.settings.discretisation = experiment.discretisation;
  result.settings.initial = initial_belief(experiment, even.record, result.model, beam_stiffness);
  result.settings.output_noise = result.noise_deviation.cwiseAbs2().asDiagonal();
  result.settings.passes = passes;
  result.settings.on_failure = experiment.on_failure;
  return result;
}

RecordIdentification identify_record(const Experiment& experiment, const Record& record,
                                     const VectorXd& quiet_noise) {
  RecordIdentification result = prepare_identification(experiment, record);
  result.noise_method = experiment.noise_method.name;
  const filters::Measurements measured = measurements(record);
  const auto filter = [&] {
    at_place(experiment.filter.place, [&] {
      result.last_start = result.settings.initial;
      result.identification = identify(result.model, measured, result.settings, filters::Keep::all_beliefs);
      if (!result.identification.run.failure) refine(result, measured);
      return 0;
    });
  };
  if (result.noise_method == "before_event") take_quiet_noise(quiet_noise, record, result);
  filter();
  if (result.noise_method == "likelihood" && !result.identification.run.failure) {
    take_likeliest_noise(experiment, record, result);
    result.interval_factor = widening(result);
    filter();
  }
  if (experiment.estimator != "filter") result.batch = identify_batch(result, measured);
  const filters::FilterRun& run = result.identification.run;
  result.diagnostics = diagnostics_of(run, result.settings.initial, result.model.unknown_places);
  if (run.failure) return result;

  if (result.diagnostics) result.consistency = result.diagnostics->consistency;
  if (!experiment.smoother.empty()) result.smoothed = smoothed(experiment, result, measured);
  if (result.identification.found.damping_ratio() < 1.0)
    result.reproduced = reproduced(record, result.identification.found.eigenvalue());
  return result;
}

}  // namespace beamid::experiments
