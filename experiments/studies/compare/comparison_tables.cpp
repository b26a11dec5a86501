#include "experiments/studies/compare/comparison_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/config/channel_places.hpp"
#include "experiments/identify/measured_force.hpp"
#include "experiments/studies/compare/comparison_figures.hpp"
#include "experiments/studies/compare/comparison_words.hpp"

namespace beamid::experiments {
namespace {

double or_nan(const std::optional<double>& value) {
  return value.value_or(std::nan(""));
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

}  // namespace

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
      "what the best motion of the model with these parameters leaves of the record.";
  return table;
}

// One parameter over all runs.
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

std::vector<std::string> parameter_names(const Comparison& comparison) {
  std::vector<std::string> names;
  for (const ComparedRun& run : comparison.runs)
    for (const ComparedParameter& p : run.parameters)
      if (std::find(names.begin(), names.end(), p.estimate.name) == names.end())
        names.push_back(p.estimate.name);
  return names;
}

}  // namespace beamid::experiments
