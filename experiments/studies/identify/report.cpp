#include "experiments/studies/identify/report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "experiments/config/description.hpp"
#include "experiments/identify/engine/identified_parameters.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/record/units.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/results/results.hpp"
#include "experiments/studies/compare/report.hpp"
#include "experiments/text/fields.hpp"

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

namespace {

using Eigen::Index, Eigen::VectorXd;

struct History {
  VectorXd mean, deviation;
};

History history(const std::vector<filters::Gaussian>& estimates, Index state) {
  const auto samples = static_cast<Index>(estimates.size());
  History result{VectorXd(samples), VectorXd(samples)};
  for (Index k = 0; k < samples; ++k) {
    const filters::Gaussian& estimate = estimates[static_cast<std::size_t>(k)];
    result.mean[k] = estimate.mean[state];
    result.deviation[k] = std::sqrt(std::max(0.0, estimate.marginal(state, 1)(0, 0)));
  }
  return result;
}

Panel panel_of(const SmoothedRecord& record, Index state) {
  const filters::Label label = record.model.motion->state_labels()[static_cast<std::size_t>(state)];
  const auto samples = static_cast<Index>(record.smoothed.size());
  const VectorXd time = record.time.head(samples);
  const History filtered = history(record.filtered, state), after = history(record.smoothed, state);
  const VectorXd wide = quantile_95 * filtered.deviation, narrow = quantile_95 * after.deviation;
  return Panel{"", {"time [s]"}, {label.name + (label.unit.empty() ? "" : " [" + label.unit + "]")}}
      .band("filter, 95 %", time, filtered.mean - wide, filtered.mean + wide, Colour::grey)
      .dashed("filter", time, filtered.mean, Colour::black)
      .band("smoother, 95 %", time, after.mean - narrow, after.mean + narrow, Colour::sky)
      .line("smoother", time, after.mean, Colour::blue);
}

}  // namespace

Attachment smoothed_history(const SmoothedRecord& record) {
  const auto labels = record.model.motion->state_labels();
  std::string text = "time_s";
  for (const filters::Label& label : labels)
    text +=
        "," + column_key(label.name, label.unit) + "," + column_key(label.name + "_deviation", label.unit);
  text += "\n";
  for (std::size_t k = 0; k < record.smoothed.size(); ++k) {
    const VectorXd deviation = record.smoothed[k].deviations();
    text += csv_field(record.time[static_cast<Index>(k)]);
    for (Index i = 0; i < deviation.size(); ++i)
      text += "," + csv_field(record.smoothed[k].mean[i]) + "," + csv_field(deviation[i]);
    text += "\n";
  }
  return {{"smoothed.csv"},
          [text](const std::filesystem::path& folder) { write_file(folder / "smoothed.csv", text); }};
}

Figure smoothed_figure(const SmoothedRecord& record, double frequency_hz) {
  constexpr std::size_t most_unknowns = 3;
  constexpr double cycles = 6.0, deviations = 20.0;
  const double begin = record.time[0], end = record.time[static_cast<Index>(record.smoothed.size()) - 1];
  Figure figure{"smoothed_history", {}, 0, 1};
  figure.panels.push_back(panel_of(record, 0));
  figure.panels.back().x_axis.range = {begin, std::min(end, begin + cycles / frequency_hz)};
  const auto& unknowns = record.model.unknown_places;
  for (std::size_t j = 0; j < std::min(most_unknowns, unknowns.size()); ++j) {
    Panel panel = panel_of(record, unknowns[j]);
    panel.x_axis.range = {begin, end};
    // the start of a filter is as wide as the prior, and would hide all the rest
    const double last = record.smoothed.back().mean[unknowns[j]],
                 half = deviations * record.smoothed.back().deviations()[unknowns[j]];
    if (half > 0.0) panel.y_axis.range = {last - half, last + half};
    figure.panels.push_back(panel);
  }
  figure.rows = static_cast<int>(figure.panels.size());
  figure.caption = "Filtered and smoothed motion and unknowns.";
  return figure;
}

namespace {

Table batch_table(const ComparedRun& run) {
  Table table{"batch", "Batch estimate: output-error maximum likelihood of all samples at once, no prior"};
  table.column({"parameter", "parameter"})
      .column({"unit", "unit"})
      .column({"estimate", "estimate", "{:.6g}"})
      .column({"95 % from", "lower_95", "{:.6g}"})
      .column({"to", "upper_95", "{:.6g}"})
      .column({"filter's", "filter_estimate", "{:.6g}"});
  for (std::size_t j = 0; j < run.batch->parameters.size(); ++j) {
    const Estimate& e = run.batch->parameters[j];
    table.row({e.name, e.unit, e.value, e.lower_95, e.upper_95, run.parameters[j].estimate.value});
  }
  table.note = "Its intervals take the noise as white.";
  if (run.batch->estimate.status != filters::BatchStatus::converged)
    table.note += " It did not converge: " + run.batch->estimate.reason + ".";
  return table;
}

}  // namespace

Results identification_report(const Experiment& experiment, const Comparison& found) {
  const ComparedRun& run = found.runs.at(0);
  const Record& record = found.analysis.record;
  Results results = report(experiment, found);
  results.command = "identify";
  std::vector<std::string> outputs;
  for (const Eigen::Index i : output_channels(record))
    outputs.push_back(record.channels[static_cast<std::size_t>(i)].name);
  if (const std::string text = failures_paragraph(run.run.events); !text.empty()) results.limitation(text);
  if (run.batch) results.table(batch_table(run));
  if (run.diagnostics) {
    results.paragraph(words(*run.diagnostics, outputs));
    results.draw([&] { return figures(*run.diagnostics, outputs); });
  }
  if (run.smoothed.empty()) return results;
  const SmoothedRecord smoothed{record.time, *run.model, run.run.filtered, run.smoothed};
  results.figures.push_back(
      smoothed_figure(smoothed, run.frequency_hz.value_or(found.analysis.beam_frequency_hz)));
  results.attachments.push_back(smoothed_history(smoothed));
  return results;
}

using Json = nlohmann::ordered_json;

namespace {

Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

template <class Vector>
Json list(const Vector& numbers) {
  Json json = Json::array();
  for (Index i = 0; i < numbers.size(); ++i) json.push_back(finite(numbers[i]));
  return json;
}

}  // namespace

Json values(const filters::Diagnostics& found, const std::vector<std::string>& outputs) {
  Json json{{"log_likelihood", finite(found.log_likelihood)}, {"whiteness", Json::array()}};
  for (std::size_t i = 0; i < outputs.size(); ++i)
    json["whiteness"].push_back({{"output", outputs[i]},
                                 {"ljung_box_p_value", finite(found.whiteness[i].p_value)},
                                 {"autocorrelation", list(found.whiteness[i].autocorrelation)}});
  json["innovation_histogram"] = {{"edges", list(found.histogram.edges)}, {"counts", Json::array()}};
  for (Index i = 0; i < found.histogram.counts.rows(); ++i)
    json["innovation_histogram"]["counts"].push_back(list(found.histogram.counts.row(i)));
  if (!found.information) return json;
  json["information"] = {{"unknowns", found.information->ratios.size()},
                         {"rank", found.information->rank},
                         {"condition", finite(found.information->condition)},
                         {"variance_ratios", list(found.information->ratios)}};
  return json;
}

std::string words(const filters::Diagnostics& found, const std::vector<std::string>& outputs) {
  std::string text =
      fmt::format("Log-likelihood {:.6g}. Ljung-Box p, below 0.05 where innovations are not white:",
                  found.log_likelihood);
  for (std::size_t i = 0; i < outputs.size(); ++i)
    text += fmt::format("{} {} {:.2g}", i ? "," : "", outputs[i], found.whiteness[i].p_value);
  text += ".";
  if (!found.information) return text;
  const auto& told = *found.information;
  text += fmt::format(" Information about {} unknown{}: rank {}", told.ratios.size(),
                      told.ratios.size() == 1 ? "" : "s", told.rank);
  if (std::isfinite(told.condition)) text += fmt::format(", condition {:.3g}", told.condition);
  return text + (told.rank < told.ratios.size()
                     ? "; on the rest the record has less information than the prior."
                     : ".");
}

Json values(const std::vector<filters::Failure>& events) {
  Json json = Json::array();
  for (const filters::Failure& event : events)
    json.push_back({{"step", event.step},
                    {"time_s", event.time},
                    {"reason", event.reason},
                    {"smallest_eigenvalue", finite(event.smallest_eigenvalue)}});
  return json;
}

namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr std::size_t most_panels = 6;

Panel autocorrelation(const filters::Diagnostics& found, std::size_t i, const std::string& output) {
  const VectorXd& correlation = found.whiteness[i].autocorrelation;
  const Index lags = correlation.size();
  const double counted = found.histogram.counts.row(static_cast<Index>(i)).sum();
  const double bound = quantile_95 / std::sqrt(std::max(counted, 1.0));
  const double last = static_cast<double>(lags) + 1.0;
  return Panel{output, {"lag [samples]"}, {"autocorrelation"}}
      .across(0.0, last)
      .band("95 % of white noise", Eigen::Vector2d(0.0, last), Eigen::Vector2d::Constant(-bound),
            Eigen::Vector2d::Constant(bound), Colour::grey)
      .line("", Eigen::Vector2d(0.0, last), Eigen::Vector2d::Zero(), Colour::grey)
      .add(CurveStyle::stems, "innovations", VectorXd::LinSpaced(lags, 1.0, last - 1.0), correlation,
           Colour::blue);
}

// A bar's outline: its value from edge to edge.
Curve outline(const VectorXd& edges, const VectorXd& counts) {
  const Index bins = counts.size();
  Curve curve{"innovations", VectorXd(2 * bins), VectorXd(2 * bins)};
  for (Index b = 0; b < bins; ++b) {
    curve.x.segment<2>(2 * b) = edges.segment<2>(b);
    curve.y.segment<2>(2 * b).setConstant(counts[b]);
  }
  curve.colour = Colour::blue;
  return curve;
}

Panel histogram(const filters::Diagnostics& found, std::size_t i, const std::string& output) {
  const auto& h = found.histogram;
  const auto row = static_cast<Index>(i);
  const VectorXd middles = 0.5 * (h.edges.head(h.counts.cols()) + h.edges.tail(h.counts.cols()));
  Panel panel{output, {"innovation / its standard deviation"}, {"samples"}};
  panel.curves.push_back(outline(h.edges, h.counts.row(row).transpose()));
  return panel.dashed("expected", middles, h.expected.row(row).transpose(), Colour::black);
}

}  // namespace

std::vector<Figure> figures(const filters::Diagnostics& found, const std::vector<std::string>& outputs) {
  const std::size_t panels = std::min(most_panels, outputs.size());
  const int columns = panels > 1 ? 2 : 1, rows = (static_cast<int>(panels) + columns - 1) / columns;
  Figure correlations{"innovation_autocorrelation", {}, rows, columns},
      histograms{"innovation_histogram", {}, rows, columns};
  for (std::size_t i = 0; i < panels; ++i) {
    correlations.panels.push_back(autocorrelation(found, i, outputs[i]));
    histograms.panels.push_back(histogram(found, i, outputs[i]));
  }
  correlations.caption =
      "Autocorrelation of the innovations: of a filter whose model and noise are right, that of white noise.";
  histograms.caption = "Innovations over their own standard deviation, and what is expected of normal ones.";
  return {correlations, histograms};
}

}  // namespace beamid::experiments
