#include "experiments/studies/steps/steps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/LU>

#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "filters/scheme_bias.hpp"

namespace beamid::experiments {

using Eigen::Index;

std::optional<FoundMode> predicted_mode(const std::string& scheme, const FoundMode& exact, double interval) {
  try {
    const Oscillator seen = seen_through(
        scheme,
        Oscillator::from_frequency(1.0, 2.0 * std::numbers::pi * exact.frequency_hz, exact.damping_ratio),
        interval);
    return FoundMode{seen.frequency_hz(), seen.damping_ratio()};
  } catch (const std::runtime_error&) {  // no motion of the scheme is like it
    return {};
  } catch (const std::invalid_argument&) {
    return {};
  }
}

namespace {

// The closed form holds for a record without noise; with noise, scheme and exact motion weigh it alike but
// for a small part.
bool is_as_predicted(const FoundMode& found, const FoundMode& predicted, const FoundMode& exact) {
  constexpr double of_bias = 0.01, of_deviation = 0.1;
  return std::abs(found.damping_ratio - predicted.damping_ratio) <=
         of_bias * std::abs(predicted.damping_ratio - exact.damping_ratio) +
             of_deviation * exact.damping_ratio_deviation;
}

SchemeAtStep::Verdict verdict_on(const SchemeAtStep& one, const FoundMode& exact) {
  if (!one.predicted || !is_as_predicted(*one.found, *one.predicted, exact))
    return SchemeAtStep::Verdict::unexplained;
  const double shift = std::abs(one.found->damping_ratio - exact.damping_ratio);
  return shift <= quantile_95 * exact.damping_ratio_deviation ? SchemeAtStep::Verdict::harmless
                                                              : SchemeAtStep::Verdict::biased;
}

SchemeAtStep of_run(const ComparedRun& run, const SchemeAtStep* exact, double interval) {
  SchemeAtStep one;
  one.discretisation = run.discretisation;
  one.reason = run.reason;
  if (run.diagnostics && run.diagnostics->consistency)
    one.mean_nis = run.diagnostics->consistency->mean_normalised_square;
  if (exact && exact->is_valid()) one.predicted = predicted_mode(run.discretisation, *exact->found, interval);
  // A ratio that the modal analysis contradicts is what is looked for, but of the reference.
  const bool usable = exact ? run.has_estimate() : run.answers();
  if (run.has_estimate()) one.found = run.mode;
  if (!usable || !one.found) {
    if (one.reason.empty()) one.reason = to_string(run.status);
  } else if (!exact) {
    one.verdict = SchemeAtStep::Verdict::exact;
  } else if (!exact->is_valid()) {
    one.reason = "the exact discretisation has no estimate here";
  } else {
    one.verdict = verdict_on(one, *exact->found);
  }
  return one;
}

}  // namespace

const char* to_string(SchemeAtStep::Verdict verdict) {
  switch (verdict) {
    case SchemeAtStep::Verdict::exact:
      return "reference";
    case SchemeAtStep::Verdict::harmless:
      return "harmless";
    case SchemeAtStep::Verdict::biased:
      return "biased";
    case SchemeAtStep::Verdict::unexplained:
      return "UNPREDICTED";
    case SchemeAtStep::Verdict::invalid:
      return "INVALID";
  }
  return "";
}

RecordAtStep record_at_step(const Comparison& comparison, int factor) {
  const Record& record = comparison.analysis.record;
  RecordAtStep step{factor, record.interval(), record.size(), record.time[0], record.time[record.size() - 1],
                    {}};
  for (const ComparedRun& run : comparison.runs)
    step.found.push_back(of_run(run, step.found.empty() ? nullptr : step.found.data(), step.interval));
  return step;
}

namespace {

/// What a step must leave of the record.
struct StepLimits {
  double samples_per_period;
  Index samples;
};

}  // namespace

Record at_step(const IdentificationRequest& one, const Record& whole, int factor) {
  const Record& own = one.prepared.record;
  if (factor == 1) return own;
  const double* const begin = whole.time.data();
  const Index first = std::lower_bound(begin, begin + whole.size(), own.time[0]) - begin,
              drop = first % factor;  // so that the window's first sample is on the grid
  Record rest = whole;
  rest.time = whole.time.tail(whole.size() - drop);
  rest.samples = whole.samples.rightCols(whole.size() - drop);
  filters::Options options;
  options.set("factor", static_cast<double>(factor));
  const double from = own.time[0], to = own.time[own.size() - 1], slack = 0.25 * own.interval();
  const Choice step{"decimate", step_registry().completed("decimate", options)};
  rest = prepare(std::move(rest), {step}, std::pair(from, to));
  // window() takes half an interval more on both sides
  const double more = 0.5 * rest.interval() - slack;
  return rest.window(std::max(from, rest.time[0]) + more, std::min(to, rest.time[rest.size() - 1]) - more);
}

namespace {

void refuse_what_no_closed_form_knows(const Record& record) {
  for (const Index i : input_channels(record))
    throw std::invalid_argument(
        fmt::format("channel '{}' is a measured force; expected a free decay: what a discretisation does to "
                    "it is known in closed form, under a force it is not. Omit the channel from "
                    "record.channels and take a window behind the force",
                    record.channels[static_cast<std::size_t>(i)].name));
}

Comparison compare_at(const Experiment& experiment, const IdentificationRequest& one, const Record& record,
                      const std::filesystem::path& folder, const Progress& progress) {
  return compare(experiment, measured_record(one.file.filename().string(), record), folder, progress);
}

// Reasons against the experiment itself, the worst first.
void judge_steps(StepsStudy& study) {
  const FoundMode& reference = study.reference();
  constexpr double few = 8.0;
  const double per_period = 1.0 / (reference.frequency_hz * study.steps[0].interval);
  if (per_period < few)
    study.objections.emplace_back("few_samples",
                                  fmt::format("The record has {:.3g} samples a period only: too few to be "
                                              "decimated, and steps of other schemes "
                                              "than the exact one are far too long.",
                                              per_period));
  const double half = quantile_95 * reference.damping_ratio_deviation;
  for (const RecordAtStep& step : study.steps) {
    const SchemeAtStep& exact = step.found[0];
    if (!exact.is_valid()) continue;
    const double apart = std::abs(exact.found->damping_ratio - reference.damping_ratio);
    if (apart <= half) continue;
    study.objections.emplace_back(
        "decimated_shift",
        fmt::format(
            "The exact discretisation finds a damping ratio of {:.4g} % at steps of {:.4g} ms and {:.4g} % "
            "at "
            "those of the record, further apart than its interval. More than the step has changed. Higher "
            "modes, "
            "which decimation takes out, or too short a window do that; a low-pass ([[record.prepare]]) or a "
            "later window helps.",
            100.0 * exact.found->damping_ratio, 1e3 * step.interval, 100.0 * reference.damping_ratio));
    break;
  }
  for (const RecordAtStep& step : study.steps)
    for (const SchemeAtStep& one : step.found) {
      if (one.verdict == SchemeAtStep::Verdict::invalid)
        study.objections.emplace_back("no_estimate_at_step",
                                      fmt::format("{} at steps of {:.4g} ms has no valid estimate: {}.",
                                                  one.discretisation, 1e3 * step.interval, one.reason));
      if (one.verdict == SchemeAtStep::Verdict::unexplained)
        study.objections.emplace_back(
            "unexplained_step",
            fmt::format("{} at steps of {:.4g} ms finds a damping ratio of {:.5g} %, where {}. The closed "
                        "form, of one "
                        "mode in one channel without process noise, does not describe this record.",
                        one.discretisation, 1e3 * step.interval, 100.0 * one.found->damping_ratio,
                        one.predicted
                            ? fmt::format("{:.5g} % was predicted", 100.0 * one.predicted->damping_ratio)
                            : std::string("no motion of the scheme is the record's")));
    }
}

}  // namespace

Experiment as_oscillator(Experiment experiment) {
  if (experiment.model.name == "sdof" && experiment.parameters.empty()) return experiment;
  experiment.model = {"sdof", model_registry().completed("sdof", {})};
  experiment.reduction = Experiment{}.reduction;
  experiment.parameters.clear();
  return experiment;
}

StepsStudy study_steps(const StepsSettings& settings, const IdentificationRequest& one,
                       const std::filesystem::path& folder, const Progress& progress) {
  refuse_what_no_closed_form_knows(one.prepared.record);
  Experiment experiment = as_oscillator(one.experiment);
  experiment.reductions = {experiment.reduction};
  experiment.filters = {experiment.filter};
  experiment.discretisations = {exact_discretisation};
  for (const std::string& scheme : settings.discretisations)
    if (scheme != exact_discretisation) experiment.discretisations.push_back(scheme);

  StepsStudy study{one.file.filename().string(), experiment.discretisations, {}, {}, {}, {}};
  if (one.experiment.model.name != experiment.model.name || !one.experiment.parameters.empty())
    study.notes.push_back(fmt::format(
        "Stiffness and damping of one degree of freedom are identified (model sdof), in place of model {}.",
        one.experiment.model.name));
  const Comparison own = compare_at(experiment, one, one.prepared.record, folder, progress);
  if (!own.analysis.modal_refusal.empty()) throw std::invalid_argument(own.analysis.modal_refusal);
  if (own.analysis.aliased)
    throw std::invalid_argument(
        "the beam's first mode lies above half the sampling rate: no filter, of whatever discretisation, "
        "identifies it; expected more than two samples a period");
  study.steps.push_back(record_at_step(own, 1));
  study.status = own.runs[0].status;
  study.objections = own.objections;
  study.objections.insert(study.objections.end(), own.runs[0].objections.begin(),
                          own.runs[0].objections.end());
  if (!study.has_reference() || !study.steps[0].found[0].found) {
    if (study.has_reference()) study.status = ComparedRun::Status::diverged;
    return study;
  }
  if (own.analysis.record.channels.size() > 1)
    study.notes.emplace_back(
        "Several channels are observed: the closed form is that of one. No motion of another scheme than the "
        "exact one has all of their histories at once, and what a filter settles on depends on their noise.");

  const StepLimits limits = settings.steps ? StepLimits{10.0 / 3.0, 50} : StepLimits{8.0, 100};
  const Record whole = prepare(one.prepared.raw, experiment.format.preparation, experiment.format.window);
  const double per_period = 1.0 / (study.reference().frequency_hz * study.steps[0].interval);
  constexpr int most_steps = 8;
  const int wanted = settings.steps.value_or(most_steps);
  for (int factor = 2; static_cast<int>(study.steps.size()) < wanted; factor *= 2) {
    const bool coarse = per_period / factor < limits.samples_per_period,
               is_short = one.prepared.record.size() / factor < limits.samples;
    if (coarse || is_short) {
      if (settings.steps)
        study.notes.push_back(
            fmt::format("{} of {} steps: with the next there would be {}.", study.steps.size(), wanted,
                        coarse ? fmt::format("{:.3g} samples a period", per_period / factor)
                               : fmt::format("{} samples", one.prepared.record.size() / factor)));
      break;
    }
    progress(fmt::format("steps of {:.4g} ms", 1e3 * factor * study.steps[0].interval));
    try {
      const Record record = at_step(one, whole, factor);
      study.steps.push_back(record_at_step(compare_at(experiment, one, record, folder, unwatched), factor));
    } catch (const std::invalid_argument& error) {  // too short a record behind the low-pass
      study.notes.push_back(fmt::format("Steps of {:.4g} ms could not be had: {}.",
                                        1e3 * factor * study.steps[0].interval, error.what()));
      break;
    }
  }
  if (study.steps.size() < 2)
    study.notes.emplace_back(
        "The record is too short, or sampled too seldom, for a longer step: errors are not extrapolated.");
  judge_steps(study);
  return study;
}

// Carried on to a step of zero.

namespace {

FoundMode at_zero(const std::vector<double>& intervals, const std::vector<FoundMode>& found, int order) {
  std::vector<Eigen::VectorXd> values;
  for (const FoundMode& mode : found)
    values.push_back(Eigen::Vector2d(mode.frequency_hz, mode.damping_ratio));
  const Eigen::VectorXd limit = carried_to_zero(intervals, values, order);
  return FoundMode{limit[0], limit[1]};
}

}  // namespace

Eigen::VectorXd carried_to_zero(const std::vector<double>& intervals,
                                const std::vector<Eigen::VectorXd>& found, int order) {
  const auto n = static_cast<Index>(found.size());
  Eigen::MatrixXd powers(n, n), values(n, found.front().size());
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double step = intervals[at] / intervals.back();
    for (Index j = 0; j < n; ++j)
      powers(i, j) = j == 0 ? 1.0 : std::pow(step, static_cast<double>(order + j - 1));
    values.row(i) = found[at].transpose();
  }
  return powers.fullPivLu().solve(values).row(0).transpose();
}

int order_of(const std::string& scheme) {
  constexpr int highest = 8;
  const std::vector<double> series =
      filters::bias_series(*filters::scheme_registry().make(scheme, {}), highest);
  for (std::size_t k = 0; k < series.size(); ++k)
    if (series[k] != 0.0) return static_cast<int>(k) + 1;
  return 0;
}

std::optional<Extrapolation> StepsStudy::extrapolated(std::size_t discretisation) const {
  constexpr std::size_t most = 4;
  constexpr double largest_step = 1.0;  // [rad]: beyond, the series is no help
  std::vector<double> intervals;
  std::vector<FoundMode> found;
  for (const RecordAtStep& step : steps) {
    const SchemeAtStep& one = step.found.at(discretisation);
    if (!one.is_valid() || found.size() == most ||
        2.0 * std::numbers::pi * one.found->frequency_hz * step.interval > largest_step)
      continue;
    intervals.push_back(step.interval);
    found.push_back(*one.found);
  }
  const int order = order_of(discretisations.at(discretisation));
  if (found.size() < 2 || order == 0) return {};
  const FoundMode limit = at_zero(intervals, found, order);
  intervals.pop_back();
  found.pop_back();
  const double without_longest = at_zero(intervals, found, order).damping_ratio;
  return Extrapolation{order, static_cast<int>(found.size()) + 1, limit.frequency_hz, limit.damping_ratio,
                       std::abs(limit.damping_ratio - without_longest)};
}

}  // namespace beamid::experiments
