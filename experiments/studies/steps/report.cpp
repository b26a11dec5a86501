#include "experiments/studies/steps/steps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "experiments/config/description.hpp"
#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/estimates.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

double half_interval(const FoundMode& mode) {
  return quantile_95 * mode.damping_ratio_deviation;
}

// "2.65 times too large"
std::string damping_error_text(double found, double exact) {
  const double times = found / exact;
  if (times > 1.5) return fmt::format("{:.3g} times too large", times);
  if (times < 0.0) return "negative";
  return fmt::format("{:.2g} % too {}", std::abs(100.0 * (times - 1.0)), times > 1.0 ? "large" : "small");
}

// How wrong a filter of one discretisation is on this record, at the record's own step and the longest.
std::string scheme_text(const StepsStudy& study, std::size_t d) {
  const RecordAtStep& own = study.steps.front();
  const SchemeAtStep& one = own.found[d];
  const FoundMode& exact = study.reference();
  if (!one.is_valid())
    return fmt::format(
        "On {} a {} filter at steps of {:.4g} ms finds no valid estimate: {}. The exact "
        "discretisation finds a damping ratio of {:.4g} +- {:.2g} % at {:.6g} Hz.",
        study.record, one.discretisation, 1e3 * own.interval, one.reason, 100.0 * exact.damping_ratio,
        100.0 * half_interval(exact), exact.frequency_hz);
  std::string text = fmt::format(
      "On {} a {} filter at steps of {:.4g} ms finds a damping ratio of {:.5g} % where the exact "
      "discretisation finds {:.4g} +- {:.2g} %: ",
      study.record, one.discretisation, 1e3 * own.interval, 100.0 * one.found->damping_ratio,
      100.0 * exact.damping_ratio, 100.0 * half_interval(exact));
  if (one.verdict == SchemeAtStep::Verdict::harmless)
    text += fmt::format("{:+.2g} % off, within that interval.",
                        percent(one.found->damping_ratio, exact.damping_ratio));
  else
    text += fmt::format("{}. Its frequency is {:+.3g} % off.",
                        damping_error_text(one.found->damping_ratio, exact.damping_ratio),
                        percent(one.found->frequency_hz, exact.frequency_hz));
  if (one.predicted)
    text += fmt::format(" The closed form predicts {:.5g} %.", 100.0 * one.predicted->damping_ratio);
  return text;
}

// Whether anything inside a filter shows its bias.
std::string innovations_note(const StepsStudy& study) {
  constexpr double clearly = 1.5;
  double most = 1.0;
  for (const RecordAtStep& step : study.steps)
    for (const SchemeAtStep& one : step.found)
      if (one.is_valid() && one.mean_nis && step.found[0].mean_nis)
        most = std::max(most, *one.mean_nis / *step.found[0].mean_nis);
  if (most > clearly)
    return fmt::format(
        "The innovations show the bias: their mean normalised square (NIS) is up to {:.3g} times that of the "
        "exact discretisation, as no motion of the scheme has all that is observed. Intervals do not show "
        "it.",
        most);
  return "Intervals and innovations (mean NIS, 1 of a consistent filter) are a filter's own and do not show "
         "a bias. A biased value is no estimate of the structure's damping, however narrow its interval.";
}

Table steps_table(const StepsStudy& study) {
  const double none = std::nan("");
  Table table{"steps", "The same record at longer and longer steps"};
  table.column({"discretisation", "discretisation"})
      .column({"step [ms]", "step_ms", "{:.4g}"})
      .column({"samples per period", "samples_per_period", "{:.3g}"})
      .column({"f [Hz]", "frequency_hz", "{:.4f}"})
      .column({"f predicted [Hz]", "predicted_frequency_hz", "{:.4f}"})
      .column({"xi [%]", "damping_ratio_percent", "{:.4f}"})
      .column({"xi predicted [%]", "predicted_damping_ratio_percent", "{:.4f}"})
      .column({"95 % +- [%]", "damping_ratio_half_interval_percent", "{:.2g}"})
      .column({"mean NIS", "mean_nis", "{:.3f}"})
      .column({"verdict", "verdict"});
  for (std::size_t d = 0; d < study.discretisations.size(); ++d)
    for (const RecordAtStep& step : study.steps) {
      const SchemeAtStep& one = step.found[d];
      const bool predicted = one.predicted.has_value(), valid = one.is_valid();
      table.row({one.discretisation, 1e3 * step.interval,
                 study.has_reference() ? 1.0 / (study.reference().frequency_hz * step.interval) : none,
                 valid ? one.found->frequency_hz : none, predicted ? one.predicted->frequency_hz : none,
                 valid ? 100.0 * one.found->damping_ratio : none,
                 predicted ? 100.0 * one.predicted->damping_ratio : none,
                 valid ? 100.0 * half_interval(*one.found) : none, one.mean_nis.value_or(none),
                 to_string(one.verdict)});
    }
  table.note = "Predicted: the closed form, from what the exact discretisation finds at the same step. " +
               innovations_note(study);
  return table;
}

Table extrapolation_table(const StepsStudy& study) {
  Table table{"extrapolation", "Carried on to a step of zero, without the closed form"};
  table.column({"discretisation", "discretisation"})
      .column({"order", "order", "{:.0f}"})
      .column({"steps used", "steps_used", "{:.0f}"})
      .column({"f at dt = 0 [Hz]", "frequency_hz", "{:.4f}"})
      .column({"xi at dt = 0 [%]", "damping_ratio_percent", "{:.4f}"})
      .column({"+- [%]", "uncertainty_percent", "{:.2g}"})
      .column({"exact at the record's step [%]", "exact_damping_ratio_percent", "{:.4f}"})
      .column({"95 % +- [%]", "exact_half_interval_percent", "{:.2g}"});
  for (std::size_t d = 1; d < study.discretisations.size(); ++d)
    if (const auto limit = study.extrapolated(d))
      table.row({study.discretisations[d], static_cast<double>(limit->order),
                 static_cast<double>(limit->steps), limit->frequency_hz, 100.0 * limit->damping_ratio,
                 100.0 * limit->uncertainty, 100.0 * study.reference().damping_ratio,
                 100.0 * half_interval(study.reference())});
  table.note = "A check and no estimate of its own; +-: what the longest step changes.";
  return table;
}

Json mode_values(const FoundMode& mode) {
  Json json{{"frequency_hz", mode.frequency_hz}, {"damping_ratio", mode.damping_ratio}};
  if (mode.damping_ratio_deviation > 0.0)
    json["damping_ratio_standard_deviation"] = mode.damping_ratio_deviation;
  if (mode.frequency_deviation_hz > 0.0)
    json["frequency_standard_deviation_hz"] = mode.frequency_deviation_hz;
  return json;
}

Json step_values(const RecordAtStep& step, std::size_t d) {
  const SchemeAtStep& one = step.found[d];
  Json json{{"factor", step.factor},
            {"step_s", step.interval},
            {"samples", step.samples},
            {"window_s", {step.from, step.to}},
            {"verdict", to_string(one.verdict)}};
  if (!one.reason.empty()) json["reason"] = one.reason;
  json["found"] = one.is_valid() ? mode_values(*one.found) : Json();
  json["predicted"] = one.predicted ? mode_values(*one.predicted) : Json();
  json["mean_nis"] = one.mean_nis ? Json(*one.mean_nis) : Json();
  return json;
}

Json study_values(const StepsStudy& study) {
  Json json{{"status", to_string(study.status)}};
  json["schemes"] = Json::array();
  for (std::size_t d = 0; d < study.discretisations.size(); ++d) {
    Json scheme{{"discretisation", study.discretisations[d]}};
    scheme["steps"] = Json::array();
    for (const RecordAtStep& step : study.steps) scheme["steps"].push_back(step_values(step, d));
    scheme["extrapolated"] = Json();
    if (const auto limit = study.extrapolated(d); limit && d > 0)
      scheme["extrapolated"] = {{"order", limit->order},
                                {"steps", limit->steps},
                                {"frequency_hz", limit->frequency_hz},
                                {"damping_ratio", limit->damping_ratio},
                                {"damping_ratio_uncertainty", limit->uncertainty}};
    json["schemes"].push_back(std::move(scheme));
  }
  return json;
}

}  // namespace

Results report(const Experiment& experiment, const StepsStudy& study) {
  Results results;
  results.command = "steps";
  results.configuration = describe(experiment, {"filter"});
  results.configuration.update(
      {{"record", study.record}, {"discretisations", study.discretisations}, {"passes", experiment.passes}});
  results.values = study_values(study);
  results.heading(experiment.title.empty() ? study.record : experiment.title);
  if (!study.has_reference()) {
    results.warning(
        fmt::format("NO REFERENCE: the exact discretisation has no estimate to compare with on {} ({}).",
                    study.record, study.steps[0].found[0].reason),
        true);
    for (const Objection& one : study.objections) results.object(one);
    results.table(steps_table(study));
    return results;
  }
  for (std::size_t d = 1; d < study.discretisations.size(); ++d) {
    if (study.steps[0].found[d].verdict == SchemeAtStep::Verdict::harmless)
      results.paragraph(scheme_text(study, d));
    else
      results.warning(scheme_text(study, d));
  }
  for (const Objection& one : study.objections) results.object(one);
  results.table(steps_table(study));
  if (Table limits = extrapolation_table(study); limits.rows() > 0) results.table(std::move(limits));
  for (const std::string& text : study.notes) results.paragraph(text);
  const RecordAtStep& own = study.steps.front();
  results.paragraph(fmt::format("{}: {} samples from {:.4f} to {:.4f} s at {:.2f} Hz. {} on sdof, {} passes.",
                                study.record, own.samples, own.from, own.to, 1.0 / own.interval,
                                experiment.filter.name, experiment.passes));
  results.figures.push_back(steps_figure(study));
  return results;
}

namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr Colour scheme_colours[] = {Colour::blue,   Colour::vermillion, Colour::green,
                                     Colour::purple, Colour::orange,     Colour::sky};

/// What is drawn over the step, of a mode.
struct Quantities {
  VectorXd frequency, ratio;  ///< [Hz], [%]
};

Quantities predicted_curve(const std::string& scheme, const FoundMode& exact, const VectorXd& steps) {
  Quantities curve{VectorXd(steps.size()), VectorXd(steps.size())};
  const Oscillator truth =
      Oscillator::from_frequency(1.0, 2.0 * std::numbers::pi * exact.frequency_hz, exact.damping_ratio);
  for (Index i = 0; i < steps.size(); ++i) {
    curve.frequency[i] = curve.ratio[i] = std::nan("");
    try {
      const Oscillator seen = seen_through(scheme, truth, steps[i]);
      curve.frequency[i] = seen.frequency_hz();
      curve.ratio[i] = 100.0 * seen.damping_ratio();
    } catch (const std::runtime_error&) {
      break;  // nor at any longer step
    }
  }
  return curve;
}

// Of the valid estimates.
Quantities found_points(const StepsStudy& study, std::size_t discretisation, VectorXd& steps) {
  std::vector<double> x, f, xi;
  for (const RecordAtStep& step : study.steps) {
    const SchemeAtStep& one = step.found[discretisation];
    if (!one.is_valid()) continue;
    x.push_back(1e3 * step.interval);
    f.push_back(one.found->frequency_hz);
    xi.push_back(100.0 * one.found->damping_ratio);
  }
  const auto vector = [](const std::vector<double>& v) {
    return VectorXd(Eigen::Map<const VectorXd>(v.data(), static_cast<Index>(v.size())));
  };
  steps = vector(x);
  return {vector(f), vector(xi)};
}

}  // namespace

Figure steps_figure(const StepsStudy& study) {
  constexpr Index points = 121;
  const double longest = 1.08 * study.steps.back().interval;
  const VectorXd steps = VectorXd::LinSpaced(points, longest / 1e4, longest), shown = 1e3 * steps;
  Panel damping{"", {"step [ms]", false, std::pair{0.0, 1e3 * longest}}, {"damping ratio [%]"}};
  Panel frequency{"", {"step [ms]", false, std::pair{0.0, 1e3 * longest}}, {"frequency [Hz]"}};
  for (std::size_t d = 0; d < study.discretisations.size(); ++d) {
    const std::string& scheme = study.discretisations[d];
    const Colour colour = scheme_colours[d % std::size(scheme_colours)];
    const Quantities curve = predicted_curve(scheme, study.reference(), steps);
    damping.line(scheme + ", predicted", shown, curve.ratio, colour);
    frequency.line(scheme + ", predicted", shown, curve.frequency, colour);
    VectorXd at;
    const Quantities found = found_points(study, d, at);
    damping.points(scheme + ", found", at, found.ratio, colour);
    frequency.points(scheme + ", found", at, found.frequency, colour);
    if (const auto limit = study.extrapolated(d); limit && d > 0) {
      const VectorXd zero = VectorXd::Zero(1);
      damping.open_points(scheme + ", extrapolated", zero,
                          VectorXd::Constant(1, 100.0 * limit->damping_ratio), colour);
      frequency.open_points(scheme + ", extrapolated", zero, VectorXd::Constant(1, limit->frequency_hz),
                            colour);
    }
  }
  Figure figure{"step_size", {damping, frequency}, 1, 2};
  figure.width = 1000;
  figure.caption =
      "One record, every sample of it and fewer. Shown: what filters of each discretisation find (points), "
      "on the "
      "curves that the closed form predicts from what the exact one finds at the record's own step.";
  return figure;
}

}  // namespace beamid::experiments
