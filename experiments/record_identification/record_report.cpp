#include <fmt/format.h>
#include <cmath>
#include <numbers>

#include "experiments/discretisation_bias.hpp"
#include "experiments/record_identification/record_figures.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

constexpr double normal_95 = 1.959963984540054;  // 97.5 % quantile of the standard normal

struct Parameter {
  const char* name;  // on the terminal
  const char* key;   // in results.json
  const char* format;
  double estimate, deviation, modal;
};

std::vector<Parameter> parameters(const RecordIdentification& r) {
  const Identification& i = r.identification;
  const Oscillator modal = Oscillator::from_frequency(
      i.found.mass, 2.0 * std::numbers::pi * r.modal.frequency_hz, r.modal.damping_ratio);
  const double widen = r.interval_factor;
  return {{"frequency [Hz]", "frequency_hz", "{:.4f}", i.found.frequency_hz(),
           widen * i.frequency_deviation_hz, r.modal.frequency_hz},
          {"damping ratio [%]", "damping_ratio", "{:.4f}", i.found.damping_ratio(),
           widen * i.damping_ratio_deviation, r.modal.damping_ratio},
          {"stiffness K [N/m]", "stiffness_n_per_m", "{:.2f}", i.found.stiffness,
           widen * i.stiffness_deviation, modal.stiffness},
          {"damping C [N s/m]", "damping_n_s_per_m", "{:.5f}", i.found.damping, widen * i.damping_deviation,
           modal.damping}};
}

Table parameter_table(const RecordIdentification& r) {
  Table table{"parameters", ""};
  table.column({"", "parameter"})
      .column({"estimate", "estimate", "{}"})
      .column({"95 % from", "lower_95", "{}"})
      .column({"to", "upper_95", "{}"})
      .column({"modal analysis", "modal_analysis", "{}"})
      .column({"difference [%]", "difference_percent", "{:+.3f}"});
  for (const Parameter& p : parameters(r)) {
    const double scale = std::string(p.key) == "damping_ratio" ? 100.0 : 1.0;  // shown in per cent
    const auto shown = [&](double value) { return fmt::format(fmt::runtime(p.format), scale * value); };
    table.row({p.name, shown(p.estimate), shown(p.estimate - normal_95 * p.deviation),
               shown(p.estimate + normal_95 * p.deviation), shown(p.modal), percent(p.estimate, p.modal)});
  }
  table.note = fmt::format(
      "Intervals take the mass as known: Meq = {:.4f} kg; a mass wrong by 1 % makes K and C wrong by 1 %. "
      "Modal "
      "analysis: eigensystem realisation polished by least squares, without the beam.",
      r.identification.found.mass);
  return table;
}

std::string verdict(const filters::InnovationConsistency& c) {
  if (c.white() && c.size_is_steady()) return "white and of steady size, as they should be";
  const char* what = c.white()            ? "white, but their size changes along the record"
                     : c.size_is_steady() ? "of steady size, but not white"
                                          : "neither white nor of steady size";
  return std::string(what) +
         ". The record then holds motion that the model does not (other modes, damping that depends on "
         "amplitude), and "
         "the intervals are a lower limit of the doubt";
}

std::string consistency_text(const RecordIdentification& r) {
  if (!r.consistency) return "The record is too short to test the innovations.";
  const auto& c = *r.consistency;
  return fmt::format(
      "Innovations: mean normalised square {:.3f} (95 % of consistent filters: {:.3f} to {:.3f}), over ten "
      "windows {:.2f} "
      "to {:.2f} ({:.2f} to {:.2f}), correlation of successive ones {:+.2f}, Ljung-Box p = {:.2g}: {}.",
      c.mean_normalised_square, c.lower_95, c.upper_95, c.windows.minCoeff(), c.windows.maxCoeff(),
      c.window_lower_95, c.window_upper_95, c.lag_one_correlation, c.whiteness_p_value, verdict(c));
}

std::string noise_text(const Record& record, const RecordIdentification& r) {
  std::string text = "Noise (standard deviation):";
  for (Eigen::Index i = 0; i < r.noise_deviation.size(); ++i)
    text += fmt::format("{} {} {:.4g} {}", i ? "," : "", to_string(record.channels[i].quantity),
                        r.noise_deviation[i], si_unit(record.channels[i].quantity));
  text += r.noise_from_record ? ", all that the modal analysis leaves of the record." : ", as configured.";
  if (r.interval_factor > 1.0)
    text += fmt::format(" Near the mode it is denser than that: intervals are widened by {:.2f}.",
                        r.interval_factor);
  return text;
}

std::string companion_text(const RecordIdentification& r) {
  std::string text;
  for (const CompanionMode& mode : r.modal.companions)
    text += fmt::format(
        "{}Beside the mode there is another at {:.2f} Hz with {:.0f} % of its amplitude. A model of one mode "
        "takes its "
        "decay and beat for damping: trust the modal analysis, which fits both, or a window where it has "
        "died out.",
        text.empty() ? "" : " ", mode.frequency_hz, 100.0 * mode.amplitude / r.modal.amplitude);
  return text;
}

Json values(const RecordIdentification& r, const Record& record) {
  Json json{{"status", r.identification.run.failure ? "diverged" : "converged"}};
  for (const Parameter& p : parameters(r))
    json[p.key] = {{"estimate", p.estimate},
                   {"standard_deviation", p.deviation},
                   {"lower_95", p.estimate - normal_95 * p.deviation},
                   {"upper_95", p.estimate + normal_95 * p.deviation},
                   {"modal_analysis", p.modal}};
  json["equivalent_mass_kg"] = r.identification.found.mass;
  json["beam_frequency_hz"] = r.beam_frequency_hz;
  json["window_s"] = {record.time[0], record.time[record.size() - 1]};
  json["samples"] = record.size();
  json["interval_factor"] = r.interval_factor;
  json["log_likelihood"] = r.identification.run.log_likelihood;
  if (r.consistency)
    json["innovations"] = {
        {"mean_normalised_square", r.consistency->mean_normalised_square},
        {"lower_95", r.consistency->lower_95},
        {"upper_95", r.consistency->upper_95},
        {"windows", std::vector<double>(r.consistency->windows.begin(), r.consistency->windows.end())},
        {"lag_one_correlation", r.consistency->lag_one_correlation},
        {"whiteness_p_value", r.consistency->whiteness_p_value}};
  json["modal_analysis"] = {{"frequency_hz", r.modal.frequency_hz},
                            {"damping_ratio", r.modal.damping_ratio},
                            {"frequency_standard_deviation_hz", r.modal.frequency_standard_deviation_hz},
                            {"damping_ratio_standard_deviation", r.modal.damping_ratio_standard_deviation}};
  json["modal_analysis"]["companions"] = Json::array();
  for (const CompanionMode& mode : r.modal.companions)
    json["modal_analysis"]["companions"].push_back(
        {{"frequency_hz", mode.frequency_hz},
         {"damping_ratio", mode.damping_ratio},
         {"relative_amplitude", mode.amplitude / r.modal.amplitude}});
  if (r.reproduced.size() > 0)
    json["response_error_percent"] = 100.0 * (record.samples - r.reproduced).norm() / record.samples.norm();
  if (const auto& failure = r.identification.run.failure)
    json["failure"] = {{"step", failure->step},
                       {"time_s", failure->time},
                       {"reason", failure->reason},
                       {"smallest_eigenvalue", failure->smallest_eigenvalue}};
  return json;
}

Json configuration(const Experiment& experiment, const Record& record, const RecordIdentification& r,
                   const std::string& record_name) {
  const auto choice = [](const Choice& chosen) {
    Json json{{"name", chosen.name}};
    for (const auto& [name, value] : chosen.options.values())
      std::visit([&, key = name](const auto& v) { json[key] = v; }, value);
    return json;
  };
  Json json{{"title", experiment.title},
            {"record", record_name},
            {"sampling_rate_hz", 1.0 / record.interval()},
            {"beam",
             {{"length_m", experiment.beam.length},
              {"bending_stiffness_n_m2", experiment.beam.bending_stiffness},
              {"mass_per_length_kg_per_m", experiment.beam.mass_per_length},
              {"tip_mass_kg", experiment.beam.tip_mass},
              {"tip_rotary_inertia_kg_m2", experiment.beam.tip_rotary_inertia},
              {"elements", experiment.elements}}},
            {"reduction", choice(experiment.reduction)},
            {"model", choice(experiment.model)},
            {"filter", choice(experiment.filter)}};
  json["filter"]["discretisation"] = experiment.discretisation;
  json["passes"] = r.settings.passes;
  const auto labels = r.model.motion->state_labels();
  for (std::size_t i = 0; i < labels.size(); ++i)
    json["initial"][labels[i].name] = {{"mean", r.settings.initial.mean[i]},
                                       {"standard_deviation", std::sqrt(r.settings.initial.covariance(i, i))},
                                       {"unit", labels[i].unit}};
  for (Eigen::Index i = 0; i < r.noise_deviation.size(); ++i)
    json["noise"][to_string(record.channels[i].quantity)] = r.noise_deviation[i];
  return json;
}

}  // namespace

Results report(const Experiment& experiment, const Record& record, const std::string& record_name,
               const RecordIdentification& r) {
  Results results;
  results.command = "identify";
  results.configuration = configuration(experiment, record, r, record_name);
  results.values = values(r, record);
  results.heading(experiment.title.empty() ? record_name : experiment.title);
  results.paragraph(fmt::format(
      "{}: {} samples from {:.4f} to {:.4f} s at {:.2f} Hz. {} on {}, discretisation {}, {} passes.",
      record_name, record.size(), record.time[0], record.time[record.size() - 1], 1.0 / record.interval(),
      experiment.filter.name, experiment.model.name, experiment.discretisation, r.settings.passes));
  if (const auto& failure = r.identification.run.failure) {
    results.paragraph(fmt::format("Diverged at sample {}, {:.4f} s: {} (smallest eigenvalue {:.3g}).",
                                  failure->step, failure->time, failure->reason,
                                  failure->smallest_eigenvalue));
    return results;
  }
  results.table(parameter_table(r));
  results.paragraph(consistency_text(r));
  results.paragraph(noise_text(record, r));
  results.paragraph(fmt::format(
      "The finite-element beam as described has its first mode at {:.3f} Hz; the record's is {:+.1f} % "
      "from it.",
      r.beam_frequency_hz, percent(r.identification.found.frequency_hz(), r.beam_frequency_hz)));
  if (const std::string text = companion_text(r); !text.empty()) results.paragraph(text);
  results.figures = figures(record, r);
  return results;
}

}  // namespace beamid::experiments
