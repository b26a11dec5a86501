#include "experiments/identify/judgement.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "experiments/identify/contradiction_causes.hpp"
#include "experiments/identify/identified_parameters.hpp"
#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/divergence.hpp"

namespace beamid::experiments {
namespace {

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
  judgement.messages.insert(judgement.messages.begin(), text);
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
  constexpr double hardly_white = 1e-6;
  if (!found.consistency || found.consistency->whiteness_p_value > hardly_white) return {};
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
  std::string text = fmt::format("The record hardly determines the damping ratio, {:.2g} +- {:.2g} %",
                                 100.0 * ratio, 100.0 * half);
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
    judgement.messages.push_back(
        fmt::format("No modal analysis stands beside this result: {}. The filter was started from {}, and "
                    "takes for noise what its own motion leaves of the record.",
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
    judgement.messages.insert(
        judgement.messages.begin(),
        fmt::format(
            "DIVERGED: its motion leaves {:.0f} % of the record. The record is no free decay of this beam, "
            "or [prior] is far from it.",
            found.response_error_percent(record)));
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
  for (const std::string& text : {undetermined_text(found), overtone_text(found)})
    if (!text.empty()) judgement.messages.push_back(text);
  if (!frequency && !damping) return judgement;
  std::string text = difference_text(found, frequency, damping);
  const std::string cause = cause_of(experiment, record, found);
  const bool doubtful = by_discretisation(record, found).empty() &&
                        by_prior(experiment.prior, found).empty() && modal_analysis_is_worse(record, found);
  if (doubtful)
    text += ". The modal analysis is the doubtful one: its modes leave more of the record than the filter's";
  else if (damping && !(ratio < twice * modal_ratio && twice * ratio > modal_ratio))
    judgement.verdict = ComparedRun::Status::contradicted;
  if (!cause.empty())
    text += (doubtful ? "; " : ": ") + cause;
  else if (!doubtful)
    text += ". None of the usual causes was found (scheme, prior, another mode, amplitude, rattle)";
  judgement.messages.insert(judgement.messages.begin(), text + ".");
  return judgement;
}

}  // namespace beamid::experiments
