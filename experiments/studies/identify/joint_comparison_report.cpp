#include "experiments/studies/identify/joint_comparison_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/identify/joint_comparison.hpp"
#include "experiments/identify/joint_words.hpp"
#include "experiments/results/forest_plot.hpp"
#include "experiments/studies/compare/comparison_report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::VectorXd;
using Json = nlohmann::ordered_json;

bool converged(const Comparison& one) {
  return one.runs.at(0).answers();
}

Table table_of(const JointComparison& joint, std::size_t which) {
  const Estimate& all = joint.parameters[which];
  Table table{"parameter_" + all.name, all.name + (all.unit.empty() ? "" : " [" + all.unit + "]")};
  table.column({"record", "record"})
      .column({"window [s]", "window_s"})
      .column({"estimate", "estimate"})
      .column({"95 % from", "lower_95"})
      .column({"to", "upper_95"});
  const auto row = [&](const std::string& record, const std::string& window, const Estimate& e) {
    const double half = 0.5 * (e.upper_95 - e.lower_95);
    table.row({record, window, Rounded{e.value, half}, Rounded{e.lower_95, half}, Rounded{e.upper_95, half}});
  };
  for (const Comparison& one : joint.records) {
    const VectorXd& time = one.compared.record.time;
    if (converged(one))
      row(one.compared.name, fmt::format("{:.4g} to {:.4g}", time[0], time[time.size() - 1]),
          one.runs[0].parameters.at(which).estimate);
  }
  row("all together", "", all);
  if (all.nuisance) table.note = "Not asked about: known beforehand to some accuracy, which counts once.";
  return table;
}

Panel panel_of(const JointComparison& joint, std::size_t which) {
  const Estimate& all = joint.parameters[which];
  std::string name = all.name;
  std::replace(name.begin(), name.end(), '_', ' ');
  ForestPlot plot{"", name + (all.unit.empty() ? "" : " [" + all.unit + "]"), {}, {{}}};
  for (const Comparison& one : joint.records) {
    if (!converged(one)) continue;
    const Estimate& e = one.runs[0].parameters.at(which).estimate;
    plot.names.push_back(one.compared.name);
    plot.series[0].value.push_back(e.value);
    plot.series[0].lower.push_back(e.lower_95);
    plot.series[0].upper.push_back(e.upper_95);
  }
  plot.reference = ForestReference{"all together", all.value, std::pair{all.lower_95, all.upper_95}};
  return forest_panel(plot);
}

Json joint_comparison_values_of(const JointComparison& joint, const std::vector<std::string>& names) {
  const auto values = [](const Estimate& e) {
    return Json{{"unit", e.unit},
                {"estimate", e.value},
                {"standard_deviation", e.deviation},
                {"lower_95", e.lower_95},
                {"upper_95", e.upper_95}};
  };
  Json json{{"status", joint.none_converged() ? "diverged" : "converged"}};
  for (const Estimate& e : joint.parameters) json["parameters"][e.name] = values(e);
  if (!joint.none_converged()) json["agreement"] = agreement_values(joint.estimate, names);
  for (const Comparison& one : joint.records) {
    Json record{{"record", one.compared.name}, {"status", to_string(one.runs.at(0).status)}};
    if (!one.runs[0].reason.empty()) record["reason"] = one.runs[0].reason;
    for (const ComparedParameter& p : one.runs[0].parameters)
      record["parameters"][p.estimate.name] = values(p.estimate);
    json["records"].push_back(std::move(record));
  }
  return json;
}

}  // namespace

Results report(const Experiment& experiment, const JointComparison& joint) {
  std::vector<std::string> names, notes;
  for (const Estimate& e : joint.parameters) names.push_back(e.name);
  Results results;
  results.command = "identify";
  results.configuration = report(experiment, joint.records[0]).configuration;
  for (const Comparison& one : joint.records) results.configuration["records"].push_back(one.compared.name);
  results.values = joint_comparison_values_of(joint, names);
  results.heading(experiment.title.empty() ? fmt::format("{} records", joint.records.size())
                                           : experiment.title);
  for (const Comparison& one : joint.records) {
    for (const std::string& text : one.warnings) results.warning(one.compared.name + ": " + text);
    for (const std::string& text : one.compared.notes) notes.push_back(one.compared.name + ": " + text);
  }
  results.paragraph(fmt::format(
      "{} records of one structure, each with its own start, noise and window; {} on {}, reduction {}.",
      joint.records.size(), joint.records[0].runs[0].filter, experiment.model.name,
      joint.records[0].runs[0].reduction));
  const auto lost = [&] {
    for (const Comparison& one : joint.records)
      if (!converged(one))
        results.warning(fmt::format("{} is left out: {}.", one.compared.name, one.runs[0].reason));
  };
  if (joint.none_converged()) {
    results.warning("No joint estimate: no record was identified.", true);
    lost();
    return results;
  }
  Figure figure{"agreement", {}, 0, 1, 900};
  constexpr std::size_t most_panels = 4;
  for (std::size_t j = 0; j < names.size(); ++j) {
    results.table(table_of(joint, j));
    if (j < most_panels) figure.panels.push_back(panel_of(joint, j));
  }
  figure.rows = static_cast<int>(figure.panels.size());
  figure.height = forest_height(figure.panels[0].remarks.size(), figure.panels.size());
  figure.caption = "What each record alone gives, with 95 % intervals, and what all give together.";
  results.figures = {figure};
  results.paragraph(agreement_words(joint.estimate, names));
  lost();
  for (const std::string& text : notes) results.paragraph(text);
  return results;
}

}  // namespace beamid::experiments
