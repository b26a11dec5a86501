#include "experiments/studies/compare/comparison_values.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/config/channel_places.hpp"
#include "experiments/config/description.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/identify/record_inputs.hpp"
#include "experiments/record/column_name.hpp"
#include "experiments/results/results.hpp"
#include "experiments/studies/compare/comparison_words.hpp"
#include "experiments/studies/identify/diagnostics_report.hpp"

namespace beamid::experiments {
namespace {

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

Json run_values(const ComparedRun& run, const std::vector<std::string>& outputs) {
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
  if (run.has_estimate()) json["covariance"] = json_rows(covariance_of_parameters(run));
  if (run.reproduced.size() == 0) return json;
  json["response_error_percent"] = run.response_error_percent;
  json["frequency_hz"] = optional_number(run.frequency_hz);
  json["noise"] = std::vector<double>(run.noise.begin(), run.noise.end());
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

}  // namespace

Json comparison_configuration(const Experiment& experiment, const Comparison& comparison) {
  Json json = describe(experiment, {"filter", "model", "reduction"});
  json.update(methods_of(experiment, comparison));
  if (comparison.compared.truth) json["truth"] = describe(*comparison.compared.truth);
  return json;
}

Json comparison_values(const Comparison& comparison) {
  const Record& record = comparison.compared.record;
  Json json{{"record", comparison.compared.name},          {"samples", record.size()},
            {"sampling_rate_hz", 1.0 / record.interval()}, {"channels", channel_values(record)},
            {"status", to_string(status_of(comparison))},  {"runs", Json::array()}};
  if (const auto inputs = record_inputs(record)) json["inputs_between_samples"] = to_string(inputs->path);
  std::vector<std::string> outputs;
  for (const Index i : output_channels(record)) outputs.push_back(record.channels[i].name);
  for (const ComparedRun& run : comparison.runs) json["runs"].push_back(run_values(run, outputs));
  return json;
}

}  // namespace beamid::experiments
