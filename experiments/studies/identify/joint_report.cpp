
#include "experiments/studies/identify/report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/config/description.hpp"
#include "experiments/identify/engine/joint_comparison.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/results/forest_plot.hpp"
#include "experiments/studies/compare/report.hpp"

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
  if (all.nuisance) table.note = "Not requested: known beforehand to some accuracy, which counts once.";
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
    for (const Objection& objection : one.objections) results.object(objection, one.compared.name + ": ");
    for (const std::string& text : one.compared.notes) notes.push_back(one.compared.name + ": " + text);
  }
  results.paragraph(fmt::format(
      "{} records of one structure, each with its own start, noise and window; {} on {}, reduction {}.",
      joint.records.size(), joint.records[0].runs[0].filter, experiment.model.name,
      joint.records[0].runs[0].reduction));
  const auto lost = [&] {
    for (const Comparison& one : joint.records)
      if (!converged(one))
        results.warning(fmt::format("{} is excluded: {}.", one.compared.name, one.runs[0].reason));
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

namespace {

using Json = nlohmann::ordered_json;

Table parameter_table(const BeamFamily& family) {
  Table table{"parameters", "Together"};
  table.column({"parameter", "parameter"})
      .column({"unit", "unit"})
      .column({"estimate", "estimate"})
      .column({"95 % from", "lower_95"})
      .column({"to", "upper_95"})
      .column({"requested in", "files"});
  for (std::size_t j = 0; j < family.parameters.size(); ++j) {
    const Estimate& e = family.parameters[j];
    const double half = 0.5 * (e.upper_95 - e.lower_95);
    const auto shown = [&](double value) { return Rounded{value, half}; };
    table.row({e.name, e.unit, shown(e.value), shown(e.lower_95), shown(e.upper_95), family.shared_by[j]});
  }
  return table;
}

Table member_table(const BeamFamily& family) {
  Table table{"beams", "Each beam at these parameters"};
  table.column({"file", "file"})
      .column({"record", "record"})
      .column({"length [m]", "length_m", "{:.6g}"})
      .column({"f1 [Hz]", "frequency_hz", "{:.6g}"})
      .column({"response error [%]", "response_error_percent", "{:.3g}"});
  for (std::size_t r = 0; r < family.members.size(); ++r) {
    const ComparedRun& run = family.alone[r].runs[0];
    table.row({family.members[r].name, family.members[r].record_name,
               family.members[r].experiment.structure.extent(), run.frequency_hz.value_or(std::nan("")),
               run.response_error_percent});
  }
  return table;
}

std::string agreement(const BeamFamily& family) {
  const SharedEstimate& e = family.estimate;
  if (e.freedom == 0.0)
    return "The records determine no more than these parameters: whether they agree cannot be tested.";
  const std::string measured = fmt::format("chi-squared {:.3g}, {:g} degrees of freedom, probability {:.2g}",
                                           e.chi_squared, e.freedom, e.probability);
  if (e.scatter == 1.0)
    return fmt::format("The beams agree on what they share within their noise ({}).", measured);
  return fmt::format(
      "THE BEAMS DISAGREE by more than their noise ({}). Possible causes: a clamp that gives way, a length "
      "or a mass that is "
      "not as described, or motion that the models do not have. All intervals are widened by {:.3g} "
      "(Birge's ratio), which is itself known from few records only.",
      measured, e.scatter);
}

Json json_of(const Estimate& e) {
  return {{"unit", e.unit},
          {"estimate", e.value},
          {"standard_deviation", e.deviation},
          {"lower_95", e.lower_95},
          {"upper_95", e.upper_95}};
}

}  // namespace

Results report(const BeamFamily& family) {
  Results results;
  results.command = "identify";
  for (const FamilyMember& member : family.members) {
    Json one = describe(member.experiment);
    one["file"] = member.name;
    one["record"] = member.record_name;
    results.configuration["beams"].push_back(std::move(one));
  }
  results.values["status"] = family.settled ? "converged" : "not_settled";
  results.values["rounds"] = family.rounds;
  for (std::size_t j = 0; j < family.parameters.size(); ++j) {
    Json one = json_of(family.parameters[j]);
    one["files"] = family.shared_by[j];
    results.values["parameters"][family.parameters[j].name] = std::move(one);
  }
  results.values["agreement"] = {{"chi_squared", family.estimate.chi_squared},
                                 {"degrees_of_freedom", family.estimate.freedom},
                                 {"probability", family.estimate.probability},
                                 {"scatter", family.estimate.scatter}};
  for (std::size_t r = 0; r < family.members.size(); ++r) {
    const ComparedRun& run = family.alone[r].runs[0];
    Json one{{"file", family.members[r].name},
             {"record", family.members[r].record_name},
             {"response_error_percent", run.response_error_percent}};
    for (const ComparedParameter& p : run.parameters) one["alone"][p.estimate.name] = json_of(p.estimate);
    results.values["beams"].push_back(std::move(one));
  }
  results.heading(fmt::format("{} beams that share parameters", family.members.size()));
  if (!family.settled)
    results.warning(
        fmt::format("The parameters still moved in the last of {} rounds: these numbers are not to be used. "
                    "Nearer guesses help.",
                    family.rounds),
        true);
  results.paragraph(agreement(family));
  results.table(parameter_table(family));
  results.table(member_table(family));
  return results;
}

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
      text += fmt::format("{}{} is excluded: the filter lost its motion. Identify it alone to see why.",
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
    for (const Objection& objection : one.found.judgement.objections)
      results.object(objection, one.name + ": ");
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
  if (const std::string text = lost_text(joint); !text.empty()) results.limitation(text);
  Figure figure{"agreement", {}, 2, 1, 900};
  figure.panels = {panel_of(joint, 0, "frequency [Hz]"), panel_of(joint, 1, "damping ratio [%]")};
  figure.height = forest_height(figure.panels[0].remarks.size(), 2);
  figure.caption = "What each record alone gives, with 95 % intervals, and what all give together.";
  results.figures = {figure};
  return results;
}

}  // namespace beamid::experiments
