
#include "experiments/studies/compare/report.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/config/description.hpp"
#include "experiments/config/experiment.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/measured_force.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/verdict/run_verdict.hpp"
#include "experiments/record/units.hpp"
#include "experiments/results/results.hpp"
#include "experiments/results/table.hpp"
#include "experiments/studies/identify/report.hpp"
#include "experiments/studies/reduce/report.hpp"

namespace beamid::experiments {

void add_clocks(Results& results, const Comparison& comparison) {
  const std::vector<OwnClock>& clocks = comparison.compared.clocks;
  if (clocks.empty()) return;
  Table table{"clocks", "Channels with a clock of their own"};
  table.column({"channel", "channel"})
      .column({"lag [ms]", "lag_ms", "{:.4f}"})
      .column({"deviation [ms]", "deviation_ms", "{:.2g}"})
      .column({"intervals", "intervals", "{:.2f}"});
  results.values["clocks"] = nlohmann::ordered_json::array();
  const double interval = comparison.analysis.record.interval();
  for (const OwnClock& clock : clocks) {
    const std::string& name =
        comparison.compared.record.channels[static_cast<std::size_t>(clock.channel)].name;
    table.row({name, 1e3 * clock.lag, 1e3 * clock.deviation, clock.lag / interval});
    results.values["clocks"].push_back(
        {{"channel", name}, {"lag_s", clock.lag}, {"standard_deviation_s", clock.deviation}});
  }
  table.note =
      "Behind the other channels; below 0 ahead of them. Found with the parameters, whose standard "
      "deviations allow "
      "for them. The record is used and drawn on one clock.";
  results.table(table);
}

namespace {

// What results.json has of a comparison.

/// "configuration": the experiment, how its record was identified, and the beam it was simulated from.
nlohmann::ordered_json comparison_configuration(const Experiment& experiment, const Comparison& comparison);

/// The record, the status of all runs together, converged where any is, and every run.
/// @param biases of every run by its reduction (reduction_bias())
nlohmann::ordered_json comparison_values(const Comparison& comparison,
                                         const std::vector<Eigen::VectorXd>& biases);

using Eigen::Index;
using Json = nlohmann::ordered_json;

Json optional_number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

// What would leave less of a driven record, whether or not it is said; empty where nothing was tried.
Json input_values(const ComparedRun& run, const std::vector<std::string>& outputs) {
  Json json = Json::object();
  const auto clock = [&](const LikeliestClock& found) -> Json {
    return {{"output", found.output ? Json(outputs[static_cast<std::size_t>(*found.output)]) : Json("all")},
            {"lag_s", found.lag()},
            {"lag_standard_deviation_s", run.interval_factor * found.lag_deviation()},
            {"residual_share", found.step.left_share}};
  };
  if (const auto& late = run.likeliest_clocks.late) json["likeliest_late_clock"] = clock(*late);
  if (const auto& drifting = run.likeliest_clocks.drifting) {
    json["likeliest_drifting_clock"] = clock(*drifting);
    json["likeliest_drifting_clock"].update(
        {{"growth", drifting->growth()},
         {"growth_standard_deviation", run.interval_factor * drifting->growth_deviation()}});
  }
  if (const auto& noise = run.likeliest_input_noise)
    json["likeliest_input_noise"] = {
        {"standard_deviation_si", std::vector<double>(noise->deviation.begin(), noise->deviation.end())},
        {"log_likelihood_gain", noise->gain}};
  return json;
}

// What the sections of a driven record say one by one, and how that follows the size of their motion.
Json section_values(const ComparedRun& run) {
  const SectionScatter& by = *run.sections;
  Json json{{"periods", by.periods}, {"relative_size", std::vector<double>(by.size.begin(), by.size.end())}};
  for (std::size_t j = 0; j < run.parameters.size(); ++j) {
    const Unknown& unknown = run.unknowns[j];
    const auto place = static_cast<Index>(j);
    Json values = Json::array(), deviations = Json::array();
    for (Index i = 0; i < by.sections; ++i) {
      values.push_back(unknown.to_physical(by.estimates(place, i)));
      deviations.push_back(std::abs(unknown.slope(by.estimates(place, i))) * by.own_deviation(place, i));
    }
    const SizeTrend trend = trend_with_size(by, place);
    const SizeChange change = by_twice_the_motion(trend, unknown);
    json["parameters"][run.parameters[j].estimate.name] = {
        {"estimates", std::move(values)},
        {"standard_deviations", std::move(deviations)},
        {"change_by_twice_the_motion", optional_number(change.share)},
        {"change_standard_deviation", optional_number(change.deviation)},
        {"probability_without_trend", trend.probability}};
  }
  return json;
}

Json run_values(const ComparedRun& run, const Eigen::VectorXd& bias,
                const std::vector<std::string>& outputs) {
  Json json{{"reduction", run.reduction},
            {"filter", run.filter},
            {"discretisation", run.discretisation},
            {"status", to_string(run.status)}};
  if (!run.reason.empty()) json["reason"] = run.reason;
  if (!run.step_cause.empty()) json["step_cause"] = run.step_cause;
  json["events"] = experiments::values(run.run.events);
  if (run.diagnostics) json["diagnostics"] = experiments::values(*run.diagnostics, outputs);
  json["coordinates"] = run.coordinates;
  json["observed_per_freedom"] = run.observed_per_freedom;
  json["parameters"] = Json::object();
  for (const ComparedParameter& p : run.parameters)
    json["parameters"][p.estimate.name] = {{"unit", p.estimate.unit},
                                           {"estimate", p.estimate.value},
                                           {"standard_deviation", p.estimate.deviation},
                                           {"lower_95", p.estimate.lower_95},
                                           {"upper_95", p.estimate.upper_95},
                                           {"true_value", optional_number(p.truth)},
                                           {"error_percent", optional_number(p.error_percent())},
                                           {"bound", optional_number(p.bound)},
                                           {"bound_ratio", optional_number(p.bound_ratio())}};
  for (std::size_t j = 0; j < run.parameters.size() && bias.size() > 0; ++j)
    json["parameters"][run.parameters[j].estimate.name]["reduction_bias_percent"] =
        100.0 * bias[static_cast<Index>(j)];
  if (run.has_estimate()) json["covariance"] = json_rows(covariance_of_parameters(run));
  if (run.reproduced.size() == 0) return json;
  json["response_error_percent"] = run.response_error_percent;
  json["frequency_hz"] = optional_number(run.frequency_hz);
  json["noise"] = std::vector<double>(run.noise.begin(), run.noise.end());
  if (run.sections) json["sections"] = section_values(run);
  json["log_likelihood"] = run.run.log_likelihood;
  json["mean_normalised_square"] = run.run.normalised_squares.mean();
  json.update(input_values(run, outputs));
  for (const std::string& remark : run.remarks)
    json["messages"].push_back({{"severity", to_string(Severity::note)}, {"text", remark}});
  return json;
}

// Of all runs together: converged where any is.
ComparedRun::Status status_of(const Comparison& comparison) {
  const ComparedRun* const reference = reference_run(comparison);
  return (reference ? *reference : comparison.runs.front()).status;
}

// How the record was identified: a name, or several.
Json methods_of(const Experiment& experiment, const Comparison& comparison) {
  const auto names = [&](std::string ComparedRun::*name) {
    std::vector<std::string> all;
    for (const ComparedRun& run : comparison.runs)
      if (std::find(all.begin(), all.end(), run.*name) == all.end()) all.push_back(run.*name);
    return all.size() == 1 ? Json(all[0]) : Json(all);
  };
  Json json{
      {"reduction", {{"method", names(&ComparedRun::reduction)}}},
      {"filter",
       {{"method", names(&ComparedRun::filter)}, {"discretisation", names(&ComparedRun::discretisation)}}},
      {"passes", experiment.passes},
      {"noise", {{"method", experiment.noise_method.name}}}};
  for (const auto& [quantity, deviation] : experiment.noise)
    json["noise"][quantity_key(quantity)] = deviation;
  for (const Unknown& unknown : comparison.runs[0].unknowns) {
    Json& asked = json["initial"][unknown.name] = {{"unit", unknown.unit}};
    asked["mean"] = optional_number(unknown.guess);
    asked["standard_deviation"] = optional_number(unknown.deviation);
  }
  return json;
}

Json comparison_configuration(const Experiment& experiment, const Comparison& comparison) {
  Json json = describe(experiment, {"filter", "model", "reduction"});
  json.update(methods_of(experiment, comparison));
  if (comparison.compared.truth) json["truth"] = describe(*comparison.compared.truth);
  return json;
}

Json comparison_values(const Comparison& comparison, const std::vector<Eigen::VectorXd>& biases) {
  const Record& record = comparison.compared.record;
  Json json{{"record", comparison.compared.name},          {"samples", record.size()},
            {"sampling_rate_hz", 1.0 / record.interval()}, {"channels", channel_values(record)},
            {"status", to_string(status_of(comparison))},  {"runs", Json::array()}};
  if (const auto inputs = record_inputs(record)) json["inputs_between_samples"] = to_string(inputs->path);
  std::vector<std::string> outputs;
  for (const Index i : output_channels(record)) outputs.push_back(record.channels[i].name);
  for (std::size_t i = 0; i < comparison.runs.size(); ++i)
    json["runs"].push_back(run_values(comparison.runs[i], biases[i], outputs));
  return json;
}

// The tables of a comparison.

double or_nan(const std::optional<double>& value) {
  return value.value_or(std::nan(""));
}

// Relative, of parameter j; 0 where the reduction has none.
double bias_of(const Eigen::VectorXd& biases, std::size_t j) {
  return biases.size() > 0 ? biases[static_cast<Index>(j)] : 0.0;
}

// Of a parameter, what the reference run found.
std::optional<double> reference_value(const Comparison& comparison, const std::string& name) {
  if (const ComparedRun* const reference = reference_run(comparison))
    for (const ComparedParameter& p : reference->parameters)
      if (p.estimate.name == name) return p.estimate.value;
  return {};
}

// Of motion without a measured force: it shows the ratio of stiffness to mass alone.
std::string mass_note(const ComparedRun& run, const Record& record) {
  const auto any_in = [&](const char* unit) {
    return std::any_of(run.unknowns.begin(), run.unknowns.end(),
                       [&](const Unknown& unknown) { return unknown.unit.starts_with(unit); });
  };
  const bool factors = std::any_of(run.unknowns.begin(), run.unknowns.end(),
                                   [](const Unknown& unknown) { return unknown.quantity == "factor"; });
  if (measures_force(record) || any_in("kg") || !(any_in("N") || factors)) return {};
  return std::string(" No force was measured: ") + of_unweighed_masses;
}

/// A row for each run.
Table run_table(const Comparison& comparison) {
  Table table{"runs", ""};
  table.column({"reduction", "reduction"})
      .column({"filter", "filter"})
      .column({"discretisation", "discretisation"})
      .column({"r", "coordinates", "{:.0f}"})
      .column({"O/F", "observed_per_freedom", "{:.3g}"})
      .column({"f1 [Hz]", "frequency_hz", "{:.4f}"})
      .column({"response error [%]", "response_error_percent", "{:.3g}"})
      .column({"status", "status"});
  for (const ComparedRun& run : comparison.runs) {
    table.row({run.reduction, run.filter, run.discretisation, static_cast<double>(run.coordinates),
               run.observed_per_freedom, or_nan(run.frequency_hz),
               run.reproduced.size() > 0 ? run.response_error_percent : std::nan(""), to_string(run.status)});
  }
  table.note =
      "r: coordinates of the model. O/F: observed histories per degree of freedom. Response error: "
      "the residual of the record after the best motion of the model with these parameters.";
  return table;
}

/// One parameter, a row for each run.
Table parameter_table(const Comparison& comparison, const std::string& name) {
  Table table{"parameter_" + name, ""};
  std::string unit;
  std::optional<double> truth;
  for (const ComparedRun& run : comparison.runs)
    for (const ComparedParameter& p : run.parameters)
      if (p.estimate.name == name) {
        unit = p.estimate.unit;
        truth = p.truth;
      }
  table.title = fmt::format("{}{}{}", name, unit.empty() ? "" : " [" + unit + "]",
                            truth && std::isfinite(*truth) ? fmt::format(", true value {:.6g}", *truth) : "");
  table.column({"run", "run"})
      .column({"estimate", "estimate", "{:.6g}"})
      .column({"95 % from", "lower_95", "{:.6g}"})
      .column({"to", "upper_95", "{:.6g}"});
  const std::optional<double> reference = reference_value(comparison, name);
  if (truth)
    table.column({"error [%]", "error_percent", "{:+.4g}"});
  else
    table.column({"from reference [%]", "from_reference_percent", "{:+.3g}"});
  table.column({"deviation [%]", "deviation_percent", "{:.2g}"})
      .column({"deviation / bound", "bound_ratio", "{:.3f}"});
  for (const ComparedRun& run : comparison.runs)
    for (const ComparedParameter& p : run.parameters)
      if (p.estimate.name == name && run.has_estimate()) {
        std::vector<Cell> row{name_of(comparison, run), p.estimate.value, p.estimate.lower_95,
                              p.estimate.upper_95};
        if (truth)
          row.emplace_back(or_nan(p.error_percent()));
        else
          row.emplace_back(100.0 * (p.estimate.value / or_nan(reference) - 1.0));
        row.insert(row.end(),
                   {100.0 * p.estimate.deviation / std::abs(p.estimate.value), or_nan(p.bound_ratio())});
        table.row(row);
      }
  return table;
}

/// Of every parameter, the reduction whose bias and standard deviation together are least; empty where all
/// runs have one reduction.
std::string choice_text(const Comparison& comparison, const std::vector<Eigen::VectorXd>& biases) {
  std::set<std::string> reductions;
  std::map<std::string, std::pair<double, std::string>> best;
  for (std::size_t i = 0; i < comparison.runs.size(); ++i) {
    const ComparedRun& run = comparison.runs[i];
    if (!run.answers()) continue;
    reductions.insert(run.reduction);
    for (std::size_t j = 0; j < run.parameters.size(); ++j) {
      const Estimate& found = run.parameters[j].estimate;
      const double bias = bias_of(biases[i], j), deviation = found.deviation / std::abs(found.value),
                   expected = std::hypot(bias, deviation);
      if (found.nuisance || !std::isfinite(expected)) continue;
      if (const auto known = best.find(found.name); known != best.end() && known->second.first <= expected)
        continue;
      best[found.name] = {expected, fmt::format("{} (bias {:.2g} %, standard deviation {:.2g} %)",
                                                name_of(comparison, run), 100.0 * bias, 100.0 * deviation)};
    }
  }
  if (reductions.size() < 2) return {};
  std::string text = "Least expected error, of the reduction's bias and the standard deviation together:";
  for (const auto& [name, choice] : best)
    text += fmt::format("{} {} by {}", text.ends_with(':') ? "" : ";", name, choice.second);
  return text + ".";
}

// Of a single run, all parameters.
Table parameter_table(const ComparedRun& run, const Record& record) {
  Table table{"estimates", ""};
  table.column({"parameter", "parameter"})
      .column({"unit", "unit"})
      .column({"estimate", "estimate", "{:.6g}"})
      .column({"95 % from", "lower_95", "{:.6g}"})
      .column({"to", "upper_95", "{:.6g}"});
  const bool truth = std::any_of(run.parameters.begin(), run.parameters.end(),
                                 [](const ComparedParameter& p) { return p.truth.has_value(); });
  if (truth)
    table.column({"true value", "true_value", "{:.6g}"}).column({"error [%]", "error_percent", "{:+.4g}"});
  table.column({"deviation [%]", "deviation_percent", "{:.2g}"})
      .column({"deviation / bound", "bound_ratio", "{:.3f}"});
  for (const ComparedParameter& p : run.parameters) {
    std::vector<Cell> row{p.estimate.name, p.estimate.unit, p.estimate.value, p.estimate.lower_95,
                          p.estimate.upper_95};
    if (truth) row.insert(row.end(), {or_nan(p.truth), or_nan(p.error_percent())});
    row.insert(row.end(),
               {100.0 * p.estimate.deviation / std::abs(p.estimate.value), or_nan(p.bound_ratio())});
    table.row(row);
  }
  table.note =
      "Deviation: standard deviation of the estimate. Bound: the least that the record and what was known "
      "before allow (Cramer-Rao)." +
      mass_note(run, record);
  return table;
}

/// Of all runs, each once.
std::vector<std::string> parameter_names(const Comparison& comparison) {
  std::vector<std::string> names;
  for (const ComparedRun& run : comparison.runs)
    for (const ComparedParameter& p : run.parameters)
      if (std::find(names.begin(), names.end(), p.estimate.name) == names.end())
        names.push_back(p.estimate.name);
  return names;
}

void add_arrays(const Comparison& comparison, Results& results) {
  const bool alone = comparison.runs.size() == 1;
  for (const ComparedRun& run : comparison.runs) {
    if (run.reproduced.size() == 0) continue;
    const std::string name = alone ? "" : name_of(comparison, run);
    results.arrays.push_back({name, "innovations", run.run.innovations});
    results.arrays.push_back({name, "reproduced", run.reproduced});
  }
  results.arrays.push_back({"", "time_s", comparison.compared.record.time.transpose()});
}

// Of all runs, what several share once, with their names.
std::vector<Objection> objections_of(const Comparison& comparison) {
  std::vector<Objection> all;
  for (const ComparedRun& run : comparison.runs)
    for (const Objection& one : run.objections)
      if (std::ranges::find(all, one.text, &Objection::text) == all.end()) all.push_back(one);
  const auto named = said_once(comparison, [](const ComparedRun& run) { return texts(run.objections); });
  for (std::size_t k = 0; k < all.size(); ++k) all[k].text = named[k];
  return all;
}

}  // namespace

Results report(const Experiment& experiment, const Comparison& comparison) {
  const Record& record = comparison.compared.record;
  Results results;
  results.command = "compare";
  if (comparison.compared.truth) results.seed = comparison.compared.truth->simulation.seed;
  results.configuration = comparison_configuration(experiment, comparison);
  std::vector<Eigen::VectorXd> biases;
  for (const ComparedRun& run : comparison.runs)
    biases.push_back(reduction_bias({experiment, comparison.compared, comparison.analysis}, run));
  results.values = comparison_values(comparison, biases);
  const std::optional<RecordInputs> inputs = record_inputs(record);
  const char* const usual = comparison.runs.size() == 1 ? "Identification" : "Reduced against continuum";
  results.heading(experiment.title.empty() ? usual : experiment.title);
  for (const Objection& one : record.objections) results.object(one);
  const std::vector<Objection> of_runs = objections_of(comparison);
  const auto of_a_run = [&](const Objection& one) {
    return std::ranges::find(of_runs, one.name, &Objection::name) != of_runs.end();
  };
  for (const Objection& one : comparison.objections)
    if (!of_a_run(one)) results.object(one);
  const bool alone = comparison.runs.size() == 1;
  // Of a run without an estimate to rely on the first says why.
  const std::size_t failures = alone && !comparison.runs[0].answers() ? 1 : 0;
  std::size_t said = 0;
  for (const Objection& one : of_runs) results.object(one, {}, said++ < failures);
  if (!reference_run(comparison) && (!alone || said == 0))
    results.warning(
        alone ? fmt::format("{}: {}.", to_string(comparison.runs[0].status), comparison.runs[0].reason)
              : "No run converged.",
        true);
  results.paragraph(
      fmt::format("{}: {} samples from {:.4g} to {:.4g} s at {:.5g} Hz; {}. Model {}, {} pass{}.{}",
                  comparison.compared.name, record.size(), record.time[0], record.time[record.size() - 1],
                  1.0 / record.interval(), channels_text(record), experiment.model.name, experiment.passes,
                  experiment.passes == 1 ? "" : "es", inputs ? " " + words(*inputs) : ""));
  if (alone && comparison.runs[0].has_estimate()) results.table(parameter_table(comparison.runs[0], record));
  results.table(run_table(comparison));
  for (const std::string& name : parameter_names(comparison))
    if (!alone) results.table(parameter_table(comparison, name));
  add_clocks(results, comparison);
  if (const std::string choice = choice_text(comparison, biases); !choice.empty()) results.paragraph(choice);
  if (const ComparedRun* run = reference_run(comparison))
    add_orders({experiment, comparison.compared, comparison.analysis}, *run, results);
  for (const std::string& paragraph : words(comparison)) results.paragraph(paragraph);
  results.notes(comparison.compared.notes);
  results.draw([&] { return figures(comparison); });
  if (!TerminalOnly::holds()) add_arrays(comparison, results);
  for (const ComparedRun& run : comparison.runs) {
    const std::string name = fmt::format("{} {} {}", run.reduction, run.filter, run.discretisation);
    results.timing.emplace_back(name + " filter", run.seconds);
    results.timing.emplace_back(name + " reproduction_and_bound", run.response_seconds);
  }
  return results;
}

}  // namespace beamid::experiments
