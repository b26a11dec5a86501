#include "experiments/studies/identify/record_values.hpp"

#include <cmath>
#include <numbers>

#include "experiments/config/description.hpp"
#include "experiments/record/column_name.hpp"
#include "experiments/results/results.hpp"
#include "experiments/studies/identify/diagnostics_report.hpp"

namespace beamid::experiments {

using Json = nlohmann::ordered_json;

namespace {

Json batch_values(const RecordIdentification& found) {
  const filters::BatchEstimate& estimate = found.batch->estimate;
  const bool converged = estimate.status == filters::BatchStatus::converged;
  Json json{{"status", converged ? "converged" : "failed"}};
  if (!converged) json["reason"] = estimate.reason;
  json["passes"] = estimate.passes;
  json["log_likelihood"] = estimate.log_likelihood;
  if (found.batch->identification)
    for (const Parameter& p : parameters(found, *found.batch->identification))
      json[p.key] = {{"estimate", p.estimate},
                     {"standard_deviation", p.deviation},
                     {"lower_95", p.lower_95()},
                     {"upper_95", p.upper_95()}};
  return json;
}

Json noise_values(const RecordIdentification& found, const Record& record) {
  Json json = Json::array();
  for (Eigen::Index i = 0; i < found.noise_deviation.size(); ++i) {
    const bool from_record = found.noise_from_record[static_cast<std::size_t>(i)];
    json.push_back({{"channel", record.channels[static_cast<std::size_t>(i)].name},
                    {"standard_deviation_si", found.noise_deviation[i]},
                    {"method", from_record ? found.noise_method : "configured"}});
    if (from_record && found.noise_relative_deviation.size() > 0 &&
        std::isfinite(found.noise_relative_deviation[i]))
      json.back()["relative_standard_error"] = found.noise_relative_deviation[i];
  }
  return json;
}

Json modal_values(const RecordIdentification& found) {
  if (!found.modal_failure.empty()) return {{"failure", found.modal_failure}};
  const ModalEstimate& modal = found.modal;
  Json json{{"frequency_hz", modal.frequency_hz},
            {"damping_ratio", modal.damping_ratio},
            {"frequency_standard_deviation_hz", modal.frequency_standard_deviation_hz},
            {"damping_ratio_standard_deviation", modal.damping_ratio_standard_deviation},
            {"companions", Json::array()}};
  for (const CompanionMode& mode : modal.companions)
    json["companions"].push_back({{"frequency_hz", mode.frequency_hz},
                                  {"damping_ratio", mode.damping_ratio},
                                  {"relative_amplitude", mode.amplitude / modal.amplitude}});
  return json;
}

Json section_values(const RecordIdentification& found) {
  const auto trend = [](const SectionTrend& of, double factor) {
    return Json{{"varies", of.varies()}, {"probability", of.probability}, {"interval_factor", factor}};
  };
  Json json{{"frequency", trend(found.sections.frequency, found.frequency_factor())},
            {"damping_ratio", trend(found.sections.damping, found.damping_factor())},
            {"values", Json::array()}};
  for (const DecaySection& section : found.sections.sections)
    json["values"].push_back({{"from_s", section.from},
                              {"to_s", section.to},
                              {"amplitude", section.amplitude},
                              {"frequency_hz", section.frequency_hz},
                              {"frequency_standard_deviation_hz", section.frequency_deviation_hz},
                              {"damping_ratio", section.damping_ratio},
                              {"damping_ratio_standard_deviation", section.damping_ratio_deviation}});
  return json;
}

}  // namespace

Json values(const RecordIdentification& found, const Record& record) {
  Json json{{"status", to_string(found.judgement.verdict)}};
  for (const Parameter& p : parameters(found))
    json[p.key] = {{"estimate", p.estimate},
                   {"standard_deviation", p.deviation},
                   {"lower_95", p.lower_95()},
                   {"upper_95", p.upper_95()},
                   {"modal_analysis", number_or_null(p.modal)}};
  if (!found.identification.run.failure) json["covariance"] = json_rows(covariance_of_parameters(found));
  json["equivalent_mass_kg"] = found.identification.found.mass;
  json["beam_frequency_hz"] = found.beam_frequency_hz;
  json["window_s"] = {record.time[0], record.time[record.size() - 1]};
  json["samples"] = record.size();
  json["interval_factor"] = found.interval_factor;
  json["sections"] = section_values(found);
  json["noise_at_mode"] = {{"standard_deviation_si", found.near_mode.deviation},
                           {"freedom", found.near_mode.freedom},
                           {"slope", found.near_mode.slope},
                           {"lines", found.near_mode.lines}};
  json["noise"] = noise_values(found, record);
  if (found.batch) json["batch"] = batch_values(found);
  json["log_likelihood"] = found.identification.run.log_likelihood;
  if (found.consistency)
    json["innovations"] = {{"mean_normalised_square", found.consistency->mean_normalised_square},
                           {"lower_95", found.consistency->lower_95},
                           {"upper_95", found.consistency->upper_95},
                           {"windows", std::vector<double>(found.consistency->windows.begin(),
                                                           found.consistency->windows.end())},
                           {"lag_one_correlation", found.consistency->lag_one_correlation},
                           {"whiteness_p_value", found.consistency->whiteness_p_value}};
  json["modal_analysis"] = modal_values(found);
  if (found.reproduced.size() > 0) json["response_error_percent"] = found.response_error_percent(record);
  if (found.diagnostics) json["diagnostics"] = values(*found.diagnostics, record.channel_names());
  json["events"] = values(found.identification.run.events);
  if (const auto& failure = found.identification.run.failure)
    json["failure"] = {{"step", failure->step},
                       {"time_s", failure->time},
                       {"reason", failure->reason},
                       {"smallest_eigenvalue", failure->smallest_eigenvalue}};
  return json;
}

Json configuration(const Experiment& experiment, const Record& record, const RecordIdentification& found,
                   const std::string& record_name) {
  Json json = describe(experiment, {"filter", "model", "reduction"});
  json.update({{"record", record_name}, {"sampling_rate_hz", 1.0 / record.interval()}});
  json["passes"] = found.passes;
  const auto labels = found.model.motion->state_labels();
  for (std::size_t i = 0; i < labels.size(); ++i)
    json["initial"][labels[i].name] = {
        {"mean", found.settings.initial.mean[i]},
        {"standard_deviation", std::sqrt(found.settings.initial.covariance(i, i))},
        {"unit", labels[i].unit}};
  for (Eigen::Index i = 0; i < found.noise_deviation.size(); ++i)
    json["noise"][quantity_key(record.channels[i].quantity)] = found.noise_deviation[i];
  json["noise"]["method"] = found.noise_method;
  return json;
}

}  // namespace beamid::experiments
