#include <fmt/format.h>

#include "experiments/identify/joint_words.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/studies/identify/joint_report.hpp"
#include "experiments/studies/identify/record_values.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;
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

// Two of the four parameters, from `first` on, of every record and of all.
Table table_of(const JointIdentification& joint, const char* name, const char* title, std::size_t first) {
  constexpr std::size_t two = 2;
  Table table{name, title};
  table.column({"record", "record"}).column({"window [s]", "window_s"});
  const std::vector<Parameter> together = joint_parameters(joint);
  for (std::size_t i = first; i < first + two; ++i)
    table.column({together[i].name, together[i].key})
        .column({"95 % +-", std::string(together[i].key) + "_half_width_95"});
  const auto row = [&](const std::string& record, const std::string& window,
                       const std::vector<Parameter>& found) {
    std::vector<Cell> cells{record, window};
    for (std::size_t i = first; i < first + two; ++i) {
      const double half = found[i].shown * quantile_95 * found[i].deviation;
      const int digits = shown_decimals(half);
      cells.emplace_back(fmt::format("{:.{}f}", found[i].shown * found[i].estimate, digits));
      cells.emplace_back(fmt::format("{:.{}f}", half, digits));
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
  std::vector<double> number, value, half;
  for (std::size_t r = 0; r < joint.records.size(); ++r) {
    if (joint.records[r].lost()) continue;
    const Parameter p = parameters(joint.records[r].found)[which];
    number.push_back(static_cast<double>(r) + 1);
    value.push_back(p.shown * p.estimate);
    half.push_back(p.shown * quantile_95 * p.deviation);
  }
  const auto vector = [](const std::vector<double>& values) {
    return VectorXd(Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size())));
  };
  const Parameter all = joint_parameters(joint)[which];
  const Eigen::Vector2d ends(0.5, static_cast<double>(joint.records.size()) + 0.5);
  const auto level = [&](double height) { return VectorXd(Eigen::Vector2d::Constant(all.shown * height)); };
  Panel panel{"", {"record, in the order given"}, {label}, {}};
  panel.curves = {{"all together, 95 %",
                   ends,
                   {},
                   CurveStyle::band,
                   level(all.lower_95()),
                   level(all.upper_95()),
                   Colour::grey},
                  {"all together", ends, level(all.estimate), CurveStyle::dashed, {}, {}, Colour::black},
                  {"each record, 95 %", vector(number), vector(value), CurveStyle::points,
                   vector(value) - vector(half), vector(value) + vector(half), Colour::blue}};
  panel.x_axis.range = {ends[0], ends[1]};
  return panel;
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
  for (const IdentifiedRecord& one : joint.records)
    results.configuration["records"].push_back(configuration(experiment, one.record, one.found, one.name));
  results.values = joint_values_of(joint);
  results.heading(experiment.title.empty() ? fmt::format("{} records", joint.records.size())
                                           : experiment.title);
  for (const IdentifiedRecord& one : joint.records) {
    for (const std::string& text : one.found.judgement.messages) results.paragraph(one.name + ": " + text);
  }
  results.paragraph(fmt::format(
      "{} records of one beam, each with its own start, noise and window; {} on {}, discretisation {}.",
      joint.records.size(), experiment.filter.name, experiment.model.name, experiment.discretisation));
  if (all_lost(joint)) {
    results.paragraph("No joint estimate: the filter lost the motion of every record.");
    return results;
  }
  results.table(table_of(joint, "records", "", 0));
  results.table(constants_of(joint));
  results.paragraph(agreement_words(joint.estimate, {"K", "C"}));
  if (const std::string text = lost_text(joint); !text.empty()) results.paragraph(text);
  Figure figure{"agreement", {}, 2, 1};
  figure.panels = {panel_of(joint, 0, "frequency [Hz]"), panel_of(joint, 1, "damping ratio [%]")};
  figure.panels[0].legend = Legend::none;
  results.figures = {figure};
  return results;
}

}  // namespace beamid::experiments
