#include "experiments/identify/record_identification.hpp"

#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "experiments/config/channel_places.hpp"
#include "experiments/identify/batch.hpp"
#include "experiments/identify/first_belief.hpp"
#include "experiments/identify/mode_residual.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/identify/noise_source.hpp"
#include "experiments/identify/run_diagnostics.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/record/prepare/analysable_record.hpp"
#include "experiments/signal/missing_samples.hpp"
#include "experiments/text/method_choice.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "filters/smoother.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr int identification_passes = 2;  // the first estimate may be 20 % off; another one follows
constexpr double last_doubt = 30;         // deviations of K and C told, with which the last pass begins
// Smallest noise taken from a record, relative to its largest reading. One simulated without noise would else
// make P0 and R differ by more digits than double precision has.
constexpr double smallest_record_noise = 1e-6;

double expected_frequency_hz(const Experiment& experiment, const RecordIdentification& known) {
  if (!experiment.prior.stiffness) return known.beam_frequency_hz;
  return Oscillator{known.model.equivalent_mass, *experiment.prior.stiffness}.frequency_hz();
}

// The mode near the frequency that the beam, or the stiffness believed beforehand, leads to expect. Where the
// least squares do not converge that expectation takes its place.
void analyse_decay(const Experiment& experiment, const Record& record, RecordIdentification& known) {
  ModalAnalysisSettings settings;
  settings.expected_frequency_hz = expected_frequency_hz(experiment, known);
  try {
    known.modal = dominant_mode(record.samples.row(0).transpose(), record.interval(), settings);
  } catch (const std::invalid_argument& error) {
    std::ostringstream message;
    message << "modal analysis: " << error.what() << " (looked for near the "
            << *settings.expected_frequency_hz
            << (experiment.prior.stiffness ? " Hz of prior.stiffness_n_per_m"
                                           : " Hz of the beam as described; "
                                             "prior.stiffness_n_per_m tells better")
            << ")";
    throw std::invalid_argument(message.str());
  } catch (const std::runtime_error& error) {
    known.modal_failure = error.what();
    known.modal.frequency_hz = *settings.expected_frequency_hz;
    known.modal.damping_ratio = experiment.prior.damping_ratio.value_or(0.01);
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

// What the whole record says of every sample, by the model that the last pass was made with.
std::vector<filters::Gaussian> smoothed(const Experiment& experiment, const RecordIdentification& found,
                                        const filters::Measurements& measured) {
  const auto& settings = found.settings;
  const auto discrete = filters::discretise(found.model.motion, measured.interval(), settings.discretisation,
                                            {{}, settings.output_noise});
  return filters::smooth(found.identification.run, *discrete, measured, experiment.smoother).beliefs;
}

// What intervals are to be multiplied by: the noise near the mode counts where there is more of it than R
// says. Less is no reason for a shorter interval: a motion that the model cannot follow, clipped readings
// first of all, may leave little at the mode and yet shift it.
double interval_widening(const RecordIdentification& found) {
  return std::max(1.0, found.near_mode.student() * found.near_mode.deviation / found.noise_deviation[0]);
}

// R where the experiment does not state it, and the noise near the mode, from what the mode leaves of the
// record.
void take_residual_noise(const Experiment& experiment, const Record& record, RecordIdentification& found) {
  found.noise_deviation = mode_residual(record.samples, record.time, found.modal.rate()).standard_deviation;
  found.noise_from_record.assign(record.channels.size(), true);
  for (Index i = 0; i < record.samples.rows(); ++i) {
    found.noise_deviation[i] =
        std::max(found.noise_deviation[i], smallest_record_noise * largest_measured(record.samples.row(i)));
    if (const auto given = experiment.noise.find(record.channels[static_cast<std::size_t>(i)].quantity);
        given != experiment.noise.end()) {
      found.noise_deviation[i] = given->second;
      found.noise_from_record[static_cast<std::size_t>(i)] = false;
    }
  }
  const AnalysableRecord even = on_even_stamps(record);
  found.near_mode =
      noise_near_mode(even.record.samples.row(0).transpose(), even.record.interval(), found.modal);
  // Of one reading: what is filled in has no noise of its own, and an even grid may be denser than they are.
  found.near_mode.deviation /= std::sqrt(even.share * even.density);
  found.interval_factor = interval_widening(found);
  found.settings.output_noise = found.noise_deviation.cwiseAbs2().asDiagonal();
}

// The filter's own motion in place of a modal analysis that failed.
void take_mode_of_filter(RecordIdentification& found) {
  const Oscillator& filter = found.identification.found;
  if (!(filter.stiffness > 0.0) || !(std::abs(filter.damping_ratio()) < 1.0)) return;
  found.modal.frequency_hz = filter.frequency_hz();
  found.modal.damping_ratio = filter.damping_ratio();
}

void take_quiet_noise(const Eigen::VectorXd& quiet_noise, const Record& record, RecordIdentification& found) {
  if (quiet_noise.size() != found.noise_deviation.size())
    throw std::invalid_argument("noise.method is before_event; expected the noise of " +
                                std::to_string(found.noise_deviation.size()) + " channels before the event");
  for (Index i = 0; i < quiet_noise.size(); ++i)
    if (found.noise_from_record[static_cast<std::size_t>(i)])
      found.noise_deviation[i] =
          std::max(quiet_noise[i], smallest_record_noise * largest_measured(record.samples.row(i)));
  found.settings.output_noise = found.noise_deviation.cwiseAbs2().asDiagonal();
  found.interval_factor = interval_widening(found);
}

// Of one quantity: if it varies over the decay, what the variation leaves at the mode is no noise, and what
// its sections leave is.
double factor_of(const RecordIdentification& found, const SectionTrend& trend, double estimate,
                 double deviation) {
  if (found.sections.sections.empty()) return found.interval_factor;
  const double noise = std::min(found.interval_factor, found.sections.noise / found.noise_deviation[0]);
  const double half =
      section_half_width(trend, estimate, found.interval_factor * deviation, noise * deviation);
  return std::max(1.0, half / (quantile_95 * deviation));
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

  analyse_decay(experiment, on_even_stamps(record).record, result);
  take_residual_noise(experiment, record, result);

  const double beam_stiffness =
      result.model.equivalent_mass * std::pow(fem::modes(reduced.system, 1).angular_frequency[0], 2);
  result.settings.filter = experiment.filter.name;
  result.settings.filter_options = experiment.filter.options;
  result.settings.discretisation = experiment.discretisation;
  result.settings.initial = first_belief(experiment, record, result, beam_stiffness);
  result.settings.passes = identification_passes;
  result.settings.on_failure = experiment.on_failure;
  return result;
}

RecordIdentification identify_record(const Experiment& experiment, const Record& record,
                                     const VectorXd& quiet_noise) {
  RecordIdentification result = prepare_identification(experiment, record);
  result.noise_method = experiment.noise_method.name;
  const filters::Measurements measured = measurements(record);
  const auto failed = [&] { return result.identification.run.failure.has_value(); };
  const auto filter = [&] {
    at_place(experiment.filter.place, [&] {
      result.last_start = result.settings.initial;
      result.identification = identify(result.model, measured, result.settings, filters::Keep::all_beliefs);
      if (!failed()) refine(result, measured);
      return 0;
    });
  };
  const bool analysed = result.modal_failure.empty(), beside_others = !result.modal.companions.empty();
  // Noise stated so far below the record's would make of any start a certainty. A filter of one mode that
  // starts where the modal analysis has separated two follows the beat.
  constexpr double absurd = 1e-3;
  const bool stated_well = result.noise_deviation[0] > absurd * result.near_mode.deviation;
  if (analysed && !beside_others && stated_well) start_from_mode(experiment.prior, record.interval(), result);
  if (result.noise_method == "before_event") take_quiet_noise(quiet_noise, record, result);
  filter();
  if (analysed && beside_others && stated_well && lost(result.identification, result.modal.frequency_hz)) {
    start_from_mode(experiment.prior, record.interval(), result);
    filter();
  }
  for (int pass = 0; !analysed && !failed() && pass < identification_passes; ++pass) {
    take_mode_of_filter(result);
    take_residual_noise(experiment, record, result);
    if (result.noise_method == "before_event") take_quiet_noise(quiet_noise, record, result);
    filter();
  }
  if (result.noise_method == "likelihood" && !failed()) {
    take_likeliest_noise(experiment, record, result);
    result.interval_factor = interval_widening(result);
    filter();
  }
  if (experiment.estimator != "filter") result.batch = identify_batch(result, measured);
  const filters::FilterRun& run = result.identification.run;
  result.diagnostics = diagnostics_of(run, result.settings.initial, result.model.unknown_places);
  if (!run.failure) {
    if (result.diagnostics) result.consistency = result.diagnostics->consistency;
    if (!experiment.smoother.empty()) result.smoothed = smoothed(experiment, result, measured);
    if (std::abs(result.identification.found.damping_ratio()) < 1.0)
      result.reproduced =
          mode_residual(record.samples, record.time, result.identification.found.eigenvalue()).reproduced;
    const Record even = on_even_stamps(record).record;
    result.sections = amplitude_sections(even.samples.row(0).transpose(), even.interval(), result.modal);
  }
  result.judgement = judge(experiment, record, result);
  return result;
}

double RecordIdentification::frequency_factor() const {
  return factor_of(*this, sections.frequency, identification.found.frequency_hz(),
                   identification.frequency_deviation_hz);
}

double RecordIdentification::damping_factor() const {
  return factor_of(*this, sections.damping, identification.found.damping_ratio(),
                   identification.damping_ratio_deviation);
}

double RecordIdentification::response_error_percent(const Record& record) const {
  if (reproduced.size() == 0) return std::nan("");
  const auto measured = record.samples.array().isFinite();
  return 100.0 * std::sqrt(measured.select((record.samples - reproduced).array().square(), 0.0).sum() /
                           measured.select(record.samples.array().square(), 0.0).sum());
}

}  // namespace beamid::experiments
