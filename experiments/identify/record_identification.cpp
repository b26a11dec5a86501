#include "experiments/identify/record_identification.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/identify/compare/input_faults.hpp"
#include "experiments/identify/decay_objections.hpp"

namespace beamid::experiments {
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
  mode.frequency_hz = analysis.expected_hz;
  mode.damping_ratio = 0.01;
  if (!(filter.stiffness > 0.0) || !(std::abs(filter.damping_ratio()) < 1.0)) return mode;
  mode.frequency_hz = filter.frequency_hz();
  mode.damping_ratio = filter.damping_ratio();
  return mode;
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

// What speaks against any one decay, whatever modal analysis and filter agree on.
void take_objections(const RecordAnalysis& analysis, RecordIdentification& found) {
  const Identification& filter = found.identification;
  FoundMode mode{filter.found.frequency_hz(), filter.found.damping_ratio()};
  mode.damping_ratio_deviation = found.damping_factor() * filter.damping_ratio_deviation;
  for (const DecayObjection& one : decay_objections(analysis, mode)) {
    found.judgement.messages.insert(found.judgement.messages.begin(), one.text);
    if (one.contradicts) found.judgement.verdict = ComparedRun::Status::contradicted;
  }
}

void take_channels(const ChannelAmplitudes& channels, Judgement& judgement) {
  if (!channels.text.empty()) judgement.messages.push_back(channels.text);
  if (channels.contradict && judgement.verdict == ComparedRun::Status::converged)
    judgement.verdict = ComparedRun::Status::contradicted;
}

void take_clocks(const Record& record, const std::optional<ClockScatter>& scatter, Judgement& judgement) {
  if (!scatter || judgement.verdict == ComparedRun::Status::diverged) return;
  judgement.messages.insert(judgement.messages.begin(), clock_scatter_text(record, *scatter));
  judgement.verdict = ComparedRun::Status::contradicted;
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
  result.judgement = judge(experiment, analysis.record, result);
  if (result.judgement.verdict != ComparedRun::Status::diverged) take_objections(analysis, result);
  take_channels(analysis.channels, result.judgement);
  take_clocks(analysis.record, run.clock_scatter, result.judgement);
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
  return factor_of(*this, sections.frequency, identification.found.frequency_hz(),
                   identification.frequency_deviation_hz);
}

double RecordIdentification::damping_factor() const {
  return factor_of(*this, sections.damping, identification.found.damping_ratio(),
                   identification.damping_ratio_deviation);
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
