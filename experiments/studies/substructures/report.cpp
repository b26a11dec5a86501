#include "experiments/studies/substructures/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/config/description.hpp"
#include "experiments/identify/engine/measured_force.hpp"
#include "experiments/identify/engine/run_bound.hpp"
#include "experiments/results/forest_plot.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

// The largest of n differences in their deviations is beyond this once in 1,000 times.
double disagreement_limit(std::size_t n) {
  constexpr double chance = 1e-3;
  return std::sqrt(chi_square_limit(1.0, 1.0 - chance / static_cast<double>(n)));
}

const ComparedParameter* find(const ComparedRun& run, const std::string& name) {
  if (!run.has_estimate()) return nullptr;
  for (const ComparedParameter& parameter : run.parameters)
    if (parameter.estimate.name == name) return &parameter;
  return nullptr;
}

double or_nan(const std::optional<double>& value) {
  return value.value_or(std::nan(""));
}

double percent_of(double part, double whole) {
  return 100.0 * part / std::abs(whole);
}

// As the filter itself has it, not widened by what the record shows: that of 1991 knew no better.
double own_deviation(const ComparedRun& run, const std::string& name) {
  for (std::size_t j = 0; j < run.unknowns.size(); ++j)
    if (run.unknowns[j].name == name) return formal_deviation(run, j);
  return std::nan("");
}

// What the parts say where their sections are taken for exact: how far off, in the deviations reported.
struct ExactSections {
  double largest = 0.0, mean_square = 0.0;
  std::string parameter;
  int count = 0;
};

ExactSections exact_sections(const PartedIdentification& found) {
  ExactSections result;
  for (const IdentifiedPart& part : found.parts)
    for (const ComparedParameter& one : part.run(Sections::noisy).parameters) {
      const ComparedParameter* const exact = find(part.run(Sections::exact), one.estimate.name);
      if (!exact || !part.converged()) continue;
      const double off = std::abs(exact->estimate.value - one.truth.value_or(one.estimate.value)) /
                         own_deviation(part.run(Sections::exact), one.estimate.name);
      result.mean_square += off * off;
      ++result.count;
      if (off > result.largest) result.largest = off, result.parameter = one.estimate.name;
    }
  if (result.count > 0) result.mean_square /= result.count;
  return result;
}

bool is_simulated(const PartedIdentification& found) {
  return std::any_of(found.joined.begin(), found.joined.end(),
                     [](const JoinedParameter& one) { return one.truth.has_value(); });
}

void add_verdict(const PartedIdentification& found, Results& results) {
  std::size_t good = 0;
  for (const IdentifiedPart& part : found.parts) {
    const ComparedRun& run = part.run(Sections::noisy);
    if (run.status == ComparedRun::Status::converged)
      ++good;
    else
      results.warning(fmt::format("{}: {}, {}.", part.part.name, to_string(run.status), run.reason), true);
    if (run.status != ComparedRun::Status::contradicted)  // which says the same
      for (const Objection& one : run.objections) results.object(one, part.part.name + ": ");
  }
  const auto worst =
      std::max_element(found.joined.begin(), found.joined.end(),
                       [](const auto& a, const auto& b) { return a.disagreement < b.disagreement; });
  const auto compared = std::count_if(found.joined.begin(), found.joined.end(),
                                      [](const auto& one) { return one.disagreement > 0.0; });
  if (compared > 0 && worst->disagreement > disagreement_limit(static_cast<std::size_t>(compared)))
    results.warning(
        fmt::format("The parts disagree about {}: by {:.2g} of the standard deviations of their difference. "
                    "Something between them, or a sensor they share, is not as described.",
                    worst->name, worst->disagreement));
  if (good > 0)
    results.paragraph(
        fmt::format("{} of {} parts identified, the noise at their sections counted; parameters that "
                    "several have are joined below.",
                    good, found.parts.size()));
  else
    results.warning("No part was identified: there is no joint result.", true);
  const ExactSections exact = exact_sections(found);
  if (good == 0 || exact.count == 0) return;
  results.paragraph(fmt::format(
      "Were the motion at the sections taken for exact, {} would be {:.3g} of its own standard deviations "
      "{}; mean square of all {}: {:.3g} (1 where standard deviations are right).",
      exact.parameter, exact.largest,
      is_simulated(found) ? "off the truth" : "off what is found with its noise", exact.count,
      exact.mean_square));
}

// Motion alone knows ratios: M, C and K of a part times any factor move alike.
std::string without_forces(const PartedIdentification& found) {
  std::string names;
  for (const IdentifiedPart& part : found.parts) {
    if (part.converged() && !measures_force(part.noisy.compared.record))
      names += (names.empty() ? "" : ", ") + part.part.name;
  }
  if (names.empty()) return {};
  return fmt::format(
      "No measured force acts inside {}, and motion alone determines the ratios of stiffness and damping to "
      "mass: {}",
      names, of_unweighed_masses);
}

Table joined_table(const PartedIdentification& found) {
  Table table{"joined", "Joined"};
  const bool truth = is_simulated(found);
  table.column({"parameter", "parameter"})
      .column({"unit", "unit"})
      .column({"estimate", "estimate", "{:.5g}"})
      .column({"deviation [%]", "deviation_percent", "{:.2g}"});
  if (truth) table.column({"error [%]", "error_percent", "{:+.2g}"});
  table.column({"parts", "parts", "{:.0f}"});
  if (found.whole)
    table.column({"whole", "whole_estimate", "{:.5g}"})
        .column({"deviation [%]", "whole_deviation_percent", "{:.2g}"})
        .column({"bound [%]", "whole_bound_percent", "{:.2g}"});
  for (const JoinedParameter& one : found.joined) {
    std::vector<Cell> row{one.name, one.unit, one.value, percent_of(one.deviation, one.value)};
    if (truth) row.emplace_back(one.truth ? percent_of(one.value - *one.truth, *one.truth) : std::nan(""));
    row.emplace_back(static_cast<double>(one.parts));
    if (found.whole) {
      const ComparedParameter* const whole = find(found.whole->runs.front(), one.name);
      row.emplace_back(whole ? whole->estimate.value : std::nan(""));
      row.emplace_back(whole ? percent_of(whole->estimate.deviation, whole->estimate.value) : std::nan(""));
      row.emplace_back(whole && whole->bound ? percent_of(*whole->bound, whole->estimate.value)
                                             : std::nan(""));
    }
    table.row(row);
  }
  if (found.whole)
    table.note = "Whole: the structure with all its channels, whatever they measure taken as described.";
  return table;
}

Table part_table(const PartedIdentification& found) {
  Table table{"parts", "Part by part"};
  table.column({"part", "part"})
      .column({"parameter", "parameter"})
      .column({"estimate", "estimate", "{:.5g}"})
      .column({"deviation [%]", "deviation_percent", "{:.2g}"})
      .column({"bound [%]", "bound_percent", "{:.2g}"})
      .column({"sections exact", "exact_estimate", "{:.5g}"})
      .column({"deviation [%]", "exact_deviation_percent", "{:.2g}"});
  for (const IdentifiedPart& part : found.parts) {
    if (!part.converged()) continue;
    for (const ComparedParameter& one : part.run(Sections::noisy).parameters) {
      const ComparedParameter* const exact = find(part.run(Sections::exact), one.estimate.name);
      const double value = one.estimate.value;
      table.row({part.part.name, one.estimate.name, value, percent_of(one.estimate.deviation, value),
                 one.bound ? percent_of(*one.bound, value) : or_nan(one.bound),
                 exact ? exact->estimate.value : std::nan(""),
                 exact ? percent_of(own_deviation(part.run(Sections::exact), one.estimate.name),
                                    exact->estimate.value)
                       : std::nan("")});
    }
  }
  table.note =
      "Bound: what no unbiased estimate from this part's channels falls below, their noise at the sections "
      "counted. Sections exact: the same part as if the motion there were known without noise, "
      "and the standard deviation that the filter then reports.";
  return table;
}

// Of one part, one way: estimates, bounds, and the covariance by the filter itself.
Json run_values(const ComparedRun& run) {
  Json values{{"status", to_string(run.status)}, {"parameters", Json::array()}};
  if (!run.has_estimate()) return values;
  for (const ComparedParameter& one : run.parameters) {
    Json parameter{{"name", one.estimate.name},
                   {"unit", one.estimate.unit},
                   {"value", one.estimate.value},
                   {"deviation", one.estimate.deviation},
                   {"own_deviation", own_deviation(run, one.estimate.name)}};
    parameter["bound"] = one.bound ? Json(*one.bound) : Json(nullptr);
    values["parameters"].push_back(std::move(parameter));
  }
  const Eigen::MatrixXd covariance = covariance_of_parameters(run);
  const Eigen::VectorXd inverse = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd correlations = inverse.asDiagonal() * covariance * inverse.asDiagonal();
  values["correlations"] = json_rows(correlations);
  return values;
}

Figure joined_figure(const PartedIdentification& found) {
  ForestPlot plot{"", "estimate / joined estimate, 95 % intervals", {}, {}};
  ForestSeries parts{"parts, joined", {}, {}, {}, Colour::blue},
      whole{"whole structure", {}, {}, {}, Colour::vermillion};
  for (const JoinedParameter& one : found.joined) {
    plot.names.push_back(one.name);
    const double half = quantile_95 * one.deviation / std::abs(one.value);
    parts.value.push_back(1.0), parts.lower.push_back(1.0 - half), parts.upper.push_back(1.0 + half);
    const ComparedParameter* const own = found.whole ? find(found.whole->runs.front(), one.name) : nullptr;
    whole.value.push_back(own ? own->estimate.value / one.value : std::nan(""));
    whole.lower.push_back(own ? own->estimate.lower_95 / one.value : std::nan(""));
    whole.upper.push_back(own ? own->estimate.upper_95 / one.value : std::nan(""));
  }
  plot.series.push_back(std::move(parts));
  if (found.whole) plot.series.push_back(std::move(whole));
  Figure figure{"substructures", {forest_panel(plot)}};
  figure.height = forest_height(plot.names.size(), 1);
  figure.caption = "Parameters by substructures, joined, and by the whole structure.";
  return figure;
}

// The worst of the parts' own.
const char* substructures_status(const PartedIdentification& found) {
  auto worst = ComparedRun::Status::converged;
  for (const IdentifiedPart& part : found.parts) worst = std::max(worst, part.run(Sections::noisy).status);
  return to_string(worst);
}

}  // namespace

Results substructures_report(const Experiment& experiment, const PartedIdentification& found) {
  Results results;
  results.command = "substructures";
  results.configuration["title"] = experiment.title;
  for (const IdentifiedPart& part : found.parts)
    results.configuration["substructures"].push_back(part.part.name);
  add_verdict(found, results);
  if (!found.joined.empty()) results.table(joined_table(found));
  if (Table parts = part_table(found); parts.rows() > 0) results.table(std::move(parts));
  if (const std::string text = without_forces(found); !text.empty()) results.paragraph(text);
  if (!found.no_whole.empty()) results.paragraph(found.no_whole);
  results.values["status"] = substructures_status(found);
  results.values["joined"] = Json::array();
  for (const JoinedParameter& one : found.joined)
    results.values["joined"].push_back({{"name", one.name},
                                        {"unit", one.unit},
                                        {"value", one.value},
                                        {"deviation", one.deviation},
                                        {"parts", one.parts},
                                        {"disagreement", one.disagreement}});
  results.values["parts"] = Json::array();
  for (const IdentifiedPart& part : found.parts)
    results.values["parts"].push_back({{"name", part.part.name},
                                       {"sections_noisy", run_values(part.run(Sections::noisy))},
                                       {"sections_exact", run_values(part.run(Sections::exact))}});
  if (!found.joined.empty()) results.figures.push_back(joined_figure(found));
  return results;
}

}  // namespace beamid::experiments
