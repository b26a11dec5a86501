#include "experiments/studies/identify/joint_report.hpp"

#include <fmt/format.h>

#include "experiments/identify/joint_identification.hpp"
#include "experiments/identify/joint_words.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/results/forest_plot.hpp"
#include "experiments/studies/identify/record_values.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

// Of the joint estimate; there is no modal analysis of all records.
std::vector<Parameter> joint_parameters(const JointIdentification& joint) {
  RecordIdentification plain;
  plain.modal.frequency_hz = 1;
  return parameters(plain, joint.identification);
}

std::string window_of(const Record& record) {
  return fmt::format("{:.4g} to {:.4g}", record.time[0], record.time[record.size() - 1]);
}

// Of a value that is shown in percent.
std::string key_in_table(const Parameter& p) {
  return std::string(p.key) + (p.shown == 100 ? "_percent" : "");
}

// Two of the four parameters, from `first` on, of every record and of all.
Table table_of(const JointIdentification& joint, const char* name, const char* title, std::size_t first) {
  constexpr std::size_t two = 2;
  Table table{name, title};
  table.column({"record", "record"}).column({"window [s]", "window_s"});
  const std::vector<Parameter> together = joint_parameters(joint);
  for (std::size_t i = first; i < first + two; ++i)
    table.column({together[i].name, key_in_table(together[i])})
        .column({"95 % +-", key_in_table(together[i]) + "_half_width_95"});
  const auto row = [&](const std::string& record, const std::string& window,
                       const std::vector<Parameter>& found) {
    std::vector<Cell> cells{record, window};
    for (std::size_t i = first; i < first + two; ++i) {
      const double half = found[i].shown * quantile_95 * found[i].deviation;
      cells.emplace_back(Rounded{found[i].shown * found[i].estimate, half});
      cells.emplace_back(Rounded{half, half});
    }
    table.row(std::move(cells));
  };
  for (const IdentifiedRecord& one : joint.records)
    if (!one.lost()) row(one.name, window_of(one.record), parameters(one.found));
  row("all together", "", together);
  return table;
}

Table constants_of(const JointIdentification& joint) {
  Table table = table_of(joint, "constants", "", 2);
  table.note = fmt::format(
      "Intervals take the mass as known: Meq = {:.4f} kg; a mass wrong by 1 % makes K and C wrong by 1 %.",
      joint.identification.found.mass);
  return table;
}

std::string lost_text(const JointIdentification& joint) {
  std::string text;
  for (const IdentifiedRecord& one : joint.records)
    if (one.lost())
      text += fmt::format("{}{} is left out: the filter lost its motion. Identify it alone to see why.",
                          text.empty() ? "" : " ", one.name);
  return text;
}

Panel panel_of(const JointIdentification& joint, std::size_t which, const char* label) {
  ForestPlot plot{"", label, {}, {{}}};
  for (const IdentifiedRecord& one : joint.records) {
    if (one.lost()) continue;
    const Parameter p = parameters(one.found)[which];
    plot.names.push_back(fmt::format("{}, {} s", one.name, window_of(one.record)));
    plot.series[0].value.push_back(p.shown * p.estimate);
    plot.series[0].lower.push_back(p.shown * p.lower_95());
    plot.series[0].upper.push_back(p.shown * p.upper_95());
  }
  const Parameter all = joint_parameters(joint)[which];
  plot.reference = ForestReference{"all together", all.shown * all.estimate,
                                   std::pair{all.shown * all.lower_95(), all.shown * all.upper_95()}};
  return forest_panel(plot);
}

bool all_lost(const JointIdentification& joint) {
  return joint.estimate.unknowns.mean.size() == 0;
}

Json joint_values_of(const JointIdentification& joint) {
  Json json{{"status", all_lost(joint) ? "diverged" : "converged"}};
  if (!all_lost(joint)) {
    for (const Parameter& p : joint_parameters(joint))
      json[p.key] = {{"estimate", p.estimate},
                     {"standard_deviation", p.deviation},
                     {"lower_95", p.lower_95()},
                     {"upper_95", p.upper_95()}};
    json["equivalent_mass_kg"] = joint.identification.found.mass;
    json["agreement"] = agreement_values(joint.estimate, {"stiffness", "damping"});
  }
  json["records"] = Json::array();
  for (const IdentifiedRecord& one : joint.records) {
    json["records"].push_back({{"record", one.name}});
    json["records"].back().update(values(one.found, one.record));
  }
  return json;
}

}  // namespace

Results report(const Experiment& experiment, const JointIdentification& joint) {
  Results results;
  results.command = "identify";
  results.configuration["records"] = Json::array();
  for (const IdentifiedRecord& one : joint.records) {
    Experiment own = experiment;
    own.format.window = {one.record.time[0], one.record.time[one.record.size() - 1]};
    results.configuration["records"].push_back(configuration(own, one.record, one.found, one.name));
  }
  results.values = joint_values_of(joint);
  results.heading(experiment.title.empty() ? fmt::format("{} records", joint.records.size())
                                           : experiment.title);
  for (const IdentifiedRecord& one : joint.records) {
    for (const std::string& text : one.found.judgement.messages) results.warning(one.name + ": " + text);
  }
  results.paragraph(fmt::format(
      "{} records of one beam, each with its own start, noise and window; {} on {}, discretisation {}.",
      joint.records.size(), experiment.filter.name, experiment.model.name, experiment.discretisation));
  if (all_lost(joint)) {
    results.warning("No joint estimate: the filter lost the motion of every record.", true);
    return results;
  }
  results.table(table_of(joint, "records", "", 0));
  results.table(constants_of(joint));
  results.paragraph(agreement_words(joint.estimate, {"K", "C"}));
  if (const std::string text = lost_text(joint); !text.empty()) results.paragraph(text);
  Figure figure{"agreement", {}, 2, 1, 900};
  figure.panels = {panel_of(joint, 0, "frequency [Hz]"), panel_of(joint, 1, "damping ratio [%]")};
  figure.height = forest_height(figure.panels[0].remarks.size(), 2);
  figure.caption = "What each record alone gives, with 95 % intervals, and what all give together.";
  results.figures = {figure};
  return results;
}

}  // namespace beamid::experiments
