#include "experiments/identify/engine/record_identification.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "experiments/identify/engine/analysis.hpp"
#include "experiments/identify/engine/identified_parameters.hpp"
#include "experiments/identify/verdict/noise_near_mode.hpp"
#include "experiments/identify/verdict/run_verdict.hpp"
#include "experiments/modal/subspace_realisation.hpp"
#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/record/prepare/preparation_step.hpp"

namespace beamid::experiments {
namespace {

// Why a filter and the modal analysis of the same record contradict each other.

using Complex = std::complex<double>;

Oscillator modal_oscillator(const RecordIdentification& found) {
  return Oscillator::from_frequency(found.model.equivalent_mass,
                                    2.0 * std::numbers::pi * found.modal.frequency_hz,
                                    found.modal.damping_ratio);
}

// "964 % too large"
std::string error_text(double percent_off) {
  return fmt::format("{:.3g} % too {}", std::abs(percent_off), percent_off > 0 ? "large" : "small");
}

// Root mean square of what modes leave of the first channel.
double left_by(const Record& even, const std::vector<Complex>& modes) {
  const Eigen::MatrixXd first =
      with_mode_in_gaps(even.samples.row(0).transpose(), even.interval(), modes[0]).transpose();
  std::vector<Complex> rates = modes;
  std::vector<bool> oscillating(modes.size(), true);
  rates.emplace_back(0.0);
  oscillating.push_back(false);
  const ShapeFit fit = fit_shapes(first, even.interval(), rates, oscillating);
  return (first - fit.reconstruction).norm() / std::sqrt(static_cast<double>(first.cols()));
}

// Each cause as part of a sentence; empty where it is not the one.
std::string by_discretisation(const Record& record, const RecordIdentification& found) {
  constexpr double explained = 0.1;  // of the difference that may be left
  const std::string& scheme = found.settings.discretisation;
  const Oscillator modal = modal_oscillator(found), &filter = found.identification.found;
  const double interval = record.interval();
  try {
    const Oscillator seen = seen_through(scheme, modal, interval);
    const double predicted = seen.damping - modal.damping, difference = filter.damping - modal.damping;
    const double about = quantile_95 * found.damping_factor() * found.identification.damping_deviation;
    if (!(std::abs(predicted) > 1e-3 * std::abs(modal.damping)) ||
        std::abs(difference - predicted) > explained * std::abs(predicted) + about)
      return {};
    return fmt::format("{} at {:.4g} ms makes C {} and K {}, whatever the filter: use exponential", scheme,
                       1e3 * interval, error_text(percent(seen.damping, modal.damping)),
                       error_text(percent(seen.stiffness, modal.stiffness)));
  } catch (const std::exception&) {  // no oscillation, or a step too long for the scheme
    return {};
  }
}

std::string by_prior(const Prior& prior, const RecordIdentification& found) {
  constexpr double surely = 3;
  const Oscillator modal = modal_oscillator(found);
  if (prior.damping_ratio && prior.damping_ratio_deviation &&
      std::abs(*prior.damping_ratio - found.modal.damping_ratio) > surely * *prior.damping_ratio_deviation)
    return fmt::format("prior.damping_ratio, {:g} +- {:g}, excludes it", *prior.damping_ratio,
                       *prior.damping_ratio_deviation);
  if (prior.stiffness && prior.stiffness_deviation &&
      std::abs(*prior.stiffness - modal.stiffness) > surely * *prior.stiffness_deviation)
    return fmt::format("prior.stiffness_n_per_m, {:g} +- {:g}, excludes it", *prior.stiffness,
                       *prior.stiffness_deviation);
  return {};
}

std::string by_stated_noise(const RecordIdentification& found) {
  constexpr double far = 10;
  const double ratio = found.near_mode.deviation / found.noise_deviation[0];
  if (found.noise_from_record[0] || !(ratio > far)) return {};
  return fmt::format("[noise] states {:.3g} for the first channel, where the record has {:.3g} near the mode",
                     found.noise_deviation[0], found.near_mode.deviation);
}

std::string by_companion(const RecordIdentification& found) {
  if (found.modal.companions.empty()) return {};
  const CompanionMode& other = found.modal.companions.front();
  return fmt::format(
      "another mode at {:.2f} Hz has {:.0f} % of this one's amplitude, and a model of one mode takes its "
      "decay and beat for damping",
      other.frequency_hz, 100.0 * other.amplitude / found.modal.amplitude);
}

std::string by_amplitude(const RecordIdentification& found) {
  const AmplitudeSections& by = found.sections;
  if (by.damping.varies())
    return fmt::format("the damping ratio depends on amplitude, {:.4g} % at first and {:.4g} % at last",
                       100.0 * by.damping.values[0], 100.0 * by.damping.values[by.damping.values.size() - 1]);
  if (by.frequency.varies())
    return fmt::format("the frequency depends on amplitude, {:.6g} Hz at first and {:.6g} Hz at last",
                       by.frequency.values[0], by.frequency.values[by.frequency.values.size() - 1]);
  return {};
}

std::string by_unsteady_noise(const RecordIdentification& found) {
  constexpr double much = 10;  // of the variance, first windows against last ones
  if (!found.consistency || found.consistency->windows.size() < 4) return {};
  const auto& windows = found.consistency->windows;
  const double first = windows.head(2).mean(), last = windows.tail(2).mean();
  if (!(first > much * last)) return {};
  return fmt::format(
      "what the model cannot follow is {:.2g} times as large at the beginning as at the end: rattle, "
      "saturation, or modes that die out; try a later window",
      std::sqrt(first / last));
}

/// Whether the modal analysis' modes leave clearly more of the record than the filter's.
bool modal_analysis_is_worse(const Record& record, const RecordIdentification& found) {
  constexpr double clearly = 1.02;
  if (!(found.identification.found.damping_ratio() < 1.0)) return false;
  std::vector<Complex> modes{found.modal.rate()};
  for (const CompanionMode& other : found.modal.companions) modes.push_back(other.rate());
  const Record even = on_even_stamps(record).record;
  return left_by(even, modes) > clearly * left_by(even, {found.identification.found.eigenvalue()});
}

/// The first of the causes but the overtone, in the order of judge().
std::string cause_of(const Experiment& experiment, const Record& record, const RecordIdentification& found) {
  const std::string by_pair = found.two_modes ? "two modes stand in the place of one" : "";
  for (const std::string& text :
       {by_discretisation(record, found), by_prior(experiment.prior, found), by_stated_noise(found), by_pair,
        by_companion(found), by_amplitude(found), by_unsteady_noise(found)})
    if (!text.empty()) return text;
  return {};
}

/// A line at a multiple of the mode's frequency: readings cut off that no test of runs has found, or a
/// stiffness that is not linear. It belongs to the motion that is identified, so that no fit of two modes
/// helps.
std::string by_overtone(const RecordIdentification& found) {
  constexpr double least_share = 0.1, near = 0.02;
  for (const CompanionMode& other : found.modal.companions) {
    const double times = other.frequency_hz / found.modal.frequency_hz,
                 share = other.amplitude / found.modal.amplitude;
    const double whole = std::round(times);
    if (whole < 2 || std::abs(times - whole) > near || share < least_share) continue;
    return fmt::format(
        "An overtone at {:.4g} Hz, {:.0f} times the frequency, has {:.0f} % of the amplitude: clipped "
        "readings or a stiffness that is not linear",
        other.frequency_hz, whole, 100.0 * share);
  }
  return {};
}

// Whether the intervals of filter and modal analysis exclude each other, by more than rounding.
bool exclude_each_other(double filter, double filter_deviation, double modal, double modal_deviation,
                        double rounding) {
  const double difference = std::abs(filter - modal);
  return difference > quantile_95 * (filter_deviation + modal_deviation) &&
         difference > rounding * std::abs(modal);
}

void take_divergence(const std::string& condition, const Experiment& experiment, const Record& record,
                     const RecordIdentification& found, Judgement& judgement) {
  judgement.verdict = ComparedRun::Status::diverged;
  std::string text = fmt::format("DIVERGED: {}. ", condition);
  const std::string& scheme = found.settings.discretisation;
  const FoundMode mode{found.modal.frequency_hz, found.modal.damping_ratio, 0.0};
  if (const std::string step = step_too_long(scheme, mode, record.interval()); !step.empty())
    text += step;
  else if (const std::string prior = by_prior(experiment.prior, found); !prior.empty())
    text += fmt::format("The modal analysis finds {:.4f} Hz and {:.3g} %: {}.", found.modal.frequency_hz,
                        100.0 * found.modal.damping_ratio, prior);
  else if (const std::string noise = by_stated_noise(found); !noise.empty())
    text += fmt::format("The cause is likely that {}.", noise);
  else if (const std::string overtone = by_overtone(found); !overtone.empty())
    text += overtone + ". Try a later window.";
  else if (const std::string companion = by_companion(found); !companion.empty())
    text += fmt::format("The cause is likely that {}. Try a later window.", companion);
  else
    text += "Look at [prior] and [noise] in the experiment file, or another window.";
  if (!found.identification.run.failure) text += " Below is where the filter ended.";
  judgement.object({"diverged", text});
}

// What filter and modal analysis differ by.
std::string difference_text(const RecordIdentification& found, bool frequency, bool damping) {
  std::string text = "Filter and modal analysis disagree";
  const Oscillator& filter = found.identification.found;
  if (damping)
    text += fmt::format(" by {:+.3g} % in damping ratio",
                        percent(filter.damping_ratio(), found.modal.damping_ratio));
  if (frequency)
    text += fmt::format("{} by {:+.3g} % in frequency", damping ? " and" : "",
                        percent(filter.frequency_hz(), found.modal.frequency_hz));
  return text + ", by more than their intervals";
}

// Of a line at a multiple of the mode's frequency, where the innovations see it.
std::string overtone_text(const RecordIdentification& found) {
  constexpr double not_white = 1e-6;
  if (!found.consistency || found.consistency->whiteness_p_value > not_white) return {};
  const std::string overtone = by_overtone(found);
  if (overtone.empty()) return {};
  return overtone + ". The damping ratio may be wrong by more than its interval; try a later window.";
}

// Of an interval that is no narrower than half of its estimate to either side.
std::string undetermined_text(const RecordIdentification& found) {
  constexpr double wide = 0.5;
  const Identification& filter = found.identification;
  const double ratio = filter.found.damping_ratio(),
               half = quantile_95 * found.damping_factor() * filter.damping_ratio_deviation;
  if (!(half > wide * std::abs(ratio))) return {};
  std::string text =
      fmt::format("The damping ratio is poorly determined, {:.2g} +- {:.2g} %", 100.0 * ratio, 100.0 * half);
  for (const std::string& cause : {by_unsteady_noise(found), by_companion(found), by_amplitude(found)})
    if (!cause.empty()) return text + ": " + cause + ".";
  return text + ": noise, or too short a decay.";
}

}  // namespace

Judgement judge(const Experiment& experiment, const Record& record, const RecordIdentification& found) {
  constexpr double rounding_of_frequency = 1e-5, rounding_of_damping = 1e-3, twice = 2;
  constexpr double most_of_it = 50;  // [%]
  Judgement judgement;
  const bool alone = !found.modal_failure.empty();
  if (alone)
    judgement.objections.emplace_back(
        "no_modal_analysis",
        fmt::format("This result has no independent check. Modal analysis failed: {}. The filter started "
                    "from {}. Its noise level is its own residual.",
                    found.modal_failure, experiment.prior.stiffness ? "[prior]" : "the beam"));
  const Identification& identification = found.identification;
  const std::string condition =
      divergence(identification, alone ? std::nullopt : std::optional(found.modal.frequency_hz));
  if (!condition.empty()) {
    take_divergence(condition, experiment, record, found, judgement);
    return judgement;
  }
  if (alone) {
    if (!(found.response_error_percent(record) > most_of_it)) return judgement;
    judgement.verdict = ComparedRun::Status::diverged;
    judgement.object({"diverged",
                      fmt::format("DIVERGED: the residual of its motion is {:.0f} % of the record. "
                                  "The record is no free decay of this beam, "
                                  "or [prior] is far from it.",
                                  found.response_error_percent(record)),
                      found.response_error_percent(record), most_of_it});
    return judgement;
  }
  const Oscillator& filter = identification.found;
  const double ratio = filter.damping_ratio(), modal_ratio = found.modal.damping_ratio;
  const bool frequency = exclude_each_other(
      filter.frequency_hz(), found.frequency_factor() * identification.frequency_deviation_hz,
      found.modal.frequency_hz, found.modal.frequency_standard_deviation_hz, rounding_of_frequency);
  const bool damping =
      exclude_each_other(ratio, found.damping_factor() * identification.damping_ratio_deviation, modal_ratio,
                         found.modal.damping_ratio_standard_deviation, rounding_of_damping);
  if (const std::string text = undetermined_text(found); !text.empty())
    judgement.objections.emplace_back("undetermined_damping", text);
  if (const std::string text = overtone_text(found); !text.empty())
    judgement.objections.emplace_back("overtone", text);
  if (!frequency && !damping) return judgement;
  std::string text = difference_text(found, frequency, damping);
  const std::string cause = cause_of(experiment, record, found);
  const bool by_choice =
      !by_discretisation(record, found).empty() || !by_prior(experiment.prior, found).empty();
  const bool doubtful = !by_choice && modal_analysis_is_worse(record, found);
  const bool widened = !by_choice && !doubtful && by_stated_noise(found).empty();
  if (doubtful)
    text += ". The modal analysis is the doubtful one: the residual of its modes is larger than the filter's";
  else if (damping && !(ratio < twice * modal_ratio && twice * ratio > modal_ratio))
    judgement.verdict = ComparedRun::Status::contradicted;
  const ModalEstimate& modal = found.modal;
  if (widened && frequency)
    judgement.frequency_factor = factor_to_hold(filter.frequency_hz(), identification.frequency_deviation_hz,
                                                modal.frequency_hz, modal.frequency_standard_deviation_hz);
  if (widened && damping)
    judgement.damping_factor = factor_to_hold(ratio, identification.damping_ratio_deviation, modal_ratio,
                                              modal.damping_ratio_standard_deviation);
  if (!cause.empty())
    text += (doubtful ? "; " : ": ") + cause;
  else if (!doubtful)
    text += ". None of the usual causes was found (scheme, prior, another mode, amplitude, rattle)";
  if (widened) text += ". Intervals are widened until they hold both";
  judgement.object({"modal_disagreement", text + "."});
  return judgement;
}

namespace {

// What intervals are to be multiplied by: the noise near the mode counts where there is more of it than R
// says. Less is no reason for a shorter interval: a motion that the model cannot follow, clipped readings
// first of all, may leave little at the mode and yet shift it.
double interval_widening(const RecordIdentification& found) {
  return std::max(1.0, found.near_mode.student() * found.near_mode.deviation / found.noise_deviation[0]);
}

// The filter's own motion in place of a modal analysis that failed.
ModalEstimate mode_of_filter(const RecordIdentification& found, const RecordAnalysis& analysis) {
  const Oscillator& filter = found.identification.found;
  ModalEstimate mode;
  mode.frequency_hz = analysis.expected_hz, mode.damping_ratio = 0.01;
  if (!(filter.stiffness > 0.0) || !(std::abs(filter.damping_ratio()) < 1.0)) return mode;
  mode.frequency_hz = filter.frequency_hz();
  mode.damping_ratio = filter.damping_ratio();
  return mode;
}

// Of one quantity: if it varies over the decay, what the variation leaves at the mode is no noise, and what
// its sections leave is.
double factor_of(const RecordIdentification& found, const SectionTrend& trend, double estimate,
                 double deviation) {
  if (found.sections.sections.empty()) return std::hypot(found.interval_factor, trend.walk / deviation);
  const double noise = std::min(found.interval_factor, found.sections.noise / found.noise_deviation[0]);
  const double half =
      section_half_width(trend, estimate, found.interval_factor * deviation, noise * deviation);
  return std::max(1.0, half / (quantile_95 * deviation));
}

// What speaks against any one decay, whatever modal analysis and filter agree on.
void take_objections(const RecordAnalysis& analysis, RecordIdentification& found) {
  const Identification& filter = found.identification;
  FoundMode mode{filter.found.frequency_hz(), filter.found.damping_ratio()};
  mode.damping_ratio_deviation = found.damping_factor() * filter.damping_ratio_deviation;
  for (const DecayObjection& one : decay_objections(analysis, mode, true)) {
    found.judgement.object(one.objection);
    if (one.contradicts) found.judgement.verdict = ComparedRun::Status::contradicted;
  }
}

void take_channels(const ChannelAmplitudes& channels, Judgement& judgement) {
  if (!channels.text.empty()) judgement.objections.emplace_back("channel_amplitudes", channels.text);
  if (channels.contradict && judgement.verdict == ComparedRun::Status::converged)
    judgement.verdict = ComparedRun::Status::contradicted;
}

void take_clocks(const Record& record, const std::optional<ClockScatter>& scatter, Judgement& judgement) {
  if (!scatter || judgement.verdict == ComparedRun::Status::diverged) return;
  judgement.object({"channel_clocks", clock_scatter_text(record, *scatter)});
  judgement.verdict = ComparedRun::Status::contradicted;
}

// A mode that the record shows at its alias, at the frequency next to the described one: with the same decay
// rate [1/s].
ModalEstimate behind_its_alias(ModalEstimate mode, double described_hz, double rate) {
  const double times = std::round(described_hz / rate) * rate,
               whole = times + std::copysign(mode.frequency_hz, described_hz - times),
               lower = mode.frequency_hz / whole;
  mode.frequency_hz = whole;
  mode.damping_ratio *= lower, mode.damping_ratio_standard_deviation *= lower;
  return mode;
}

}  // namespace

RecordIdentification oscillator_of(const Experiment& experiment, const RecordAnalysis& analysis,
                                   const ComparedRun& run) {
  RecordIdentification result;
  result.model = *run.model;
  result.beam_frequency_hz = analysis.beam_frequency_hz;
  result.passes = experiment.passes;
  result.settings = run.settings;
  if (run.unknown_start.mean.size() > 0) {  // what was known, which no pass begins with
    const auto& places = run.model->unknown_places;
    filters::Gaussian& initial = result.settings.initial;
    initial.mean(places) = run.unknown_start.mean;
    if (initial.covariance.size() > 0) initial.covariance(places, places) = run.unknown_start.covariance;
  }
  if (run.run.last.mean.size() > 0) result.identification = identification_at(*run.model, run.run.last);
  result.identification.run = run.run;
  result.modal_failure = analysis.modal_failure.empty() ? analysis.modal_refusal : analysis.modal_failure;
  result.modal = analysis.modal.value_or(mode_of_filter(result, analysis));
  result.near_mode = analysis.near_mode ? *analysis.near_mode : analysis.noise_at(result.modal);
  if (analysis.modal && analysis.aliased)
    result.modal = behind_its_alias(result.modal, described_frequency_hz(experiment, analysis.record),
                                    1.0 / analysis.record.interval());
  result.noise_deviation = run.noise;
  for (const bool stated : run.noise_is_stated) result.noise_from_record.push_back(!stated);
  result.noise_method = experiment.noise_method.name;
  result.noise_relative_deviation = run.noise_relative_deviation;
  result.interval_factor = interval_widening(result);
  result.batch = run.batch;
  result.diagnostics = run.diagnostics;
  const auto own = std::min(run.remarks.size(), run.run.remarks.size());
  result.remarks.assign(run.remarks.begin() + static_cast<std::ptrdiff_t>(own), run.remarks.end());
  if (!run.run.failure) {
    if (result.diagnostics) result.consistency = result.diagnostics->consistency;
    result.smoothed = run.smoothed;
    if (std::abs(result.identification.found.damping_ratio()) < 1.0) result.reproduced = run.reproduced;
    result.sections = analysis.sections;
  }
  result.two_modes = analysis.pair && analysis.pair->speaks_against_one();
  result.judgement = judge(experiment, analysis.record, result);
  if (result.judgement.verdict != ComparedRun::Status::diverged) take_objections(analysis, result);
  take_channels(analysis.channels, result.judgement);
  take_clocks(analysis.record, run.clock_scatter, result.judgement);
  for (const Objection& one : analysis.objections) result.judgement.objections.push_back(one);
  return result;
}

RecordIdentification identify_record(const Experiment& experiment, const Record& record,
                                     const Eigen::VectorXd& quiet_noise) {
  ComparedRecord compared = measured_record("", record);
  compared.quiet_noise = quiet_noise;
  const Comparison found = identify_with_model(experiment, std::move(compared), {}, unwatched);
  if (!found.analysis.modal_refusal.empty()) throw std::invalid_argument(found.analysis.modal_refusal);
  if (!found.runs[0].oscillator)
    throw std::invalid_argument("a free decay of model sdof was expected; found model " +
                                experiment.model.name +
                                (found.analysis.forced() ? " and a channel of force" : ""));
  return *found.runs[0].oscillator;
}

double RecordIdentification::frequency_factor() const {
  return std::max(judgement.frequency_factor,
                  factor_of(*this, sections.frequency, identification.found.frequency_hz(),
                            identification.frequency_deviation_hz));
}

double RecordIdentification::damping_factor() const {
  return std::max(judgement.damping_factor,
                  factor_of(*this, sections.damping, identification.found.damping_ratio(),
                            identification.damping_ratio_deviation));
}

double RecordIdentification::noise_ratio() const {
  return interval_factor > 1.0 ? interval_factor / near_mode.student() : 1.0;
}

double RecordIdentification::response_error_percent(const Record& record) const {
  if (reproduced.size() == 0) return std::nan("");
  const auto measured = record.samples.array().isFinite();
  return 100.0 * std::sqrt(measured.select((record.samples - reproduced).array().square(), 0.0).sum() /
                           measured.select(record.samples.array().square(), 0.0).sum());
}

}  // namespace beamid::experiments
