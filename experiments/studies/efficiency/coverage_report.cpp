#include <limits>

#include <fmt/format.h>

#include "experiments/models/estimates.hpp"
#include "experiments/studies/efficiency/interval_coverage.hpp"
#include "experiments/studies/efficiency/report.hpp"
#include "experiments/text/choice.hpp"
#include "filters/monte_carlo.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

using Names = std::array<const char*, 2>;

Names names_of(const CoverageSettings& settings) {
  if (settings.model == CoverageModel::oscillator) return {"frequency", "damping ratio"};
  return {"bending stiffness", "damping ratio"};
}

Names keys_of(const CoverageSettings& settings) {
  if (settings.model == CoverageModel::oscillator) return {"frequency", "damping_ratio"};
  return {"bending_stiffness", "damping_ratio"};
}

Json coverage_configuration(const CoverageSettings& settings) {
  Json json;
  for (const NoiseColour colour : settings.colours) json["noise"].push_back(to_string(colour));
  json["model"] = to_string(settings.model);
  json["runs"] = settings.runs;
  json["damping_ratio"] = settings.damping_ratio;
  json["noise_over_amplitude"] = settings.noise;
  json["cycles"] = settings.cycles;
  json["higher_modes_over_amplitude"] = settings.higher;
  return json;
}

Json coverage_values_of(const CoverageCase& one, const Names& keys) {
  Json json{{"noise", to_string(one.colour)}, {"runs", one.runs}, {"failed", one.failed}};
  for (std::size_t q = 0; q < keys.size(); ++q) {
    const filters::Proportion inside = filters::proportion(one.inside[q], one.runs);
    json[keys[q]] = {{"inside", one.inside[q]},
                     {"coverage", inside.value()},
                     {"lower_95", inside.lower_95},
                     {"upper_95", inside.upper_95},
                     {"mean_error_over_deviation", one.mean[q]},
                     {"mean_square_error_over_deviation", one.mean_square[q]}};
  }
  return json;
}

Table table_of(const Coverage& coverage) {
  Table table{"coverage", "How often the 95 % interval holds the truth"};
  table.column({"noise", "noise"})
      .column({"interval of", "interval_of"})
      .column({"inside [%]", "inside_percent", "{:.2f}"})
      .column({"from", "inside_lower_95_percent", "{:.2f}"})
      .column({"to", "inside_upper_95_percent", "{:.2f}"})
      .column({"mean error / deviation", "mean_error_over_deviation", "{:+.3f}"})
      .column({"mean square", "mean_square_error_over_deviation", "{:.3f}"})
      .column({"failed", "failed_runs", "{:.0f}"});
  const Names names = names_of(coverage.settings);
  for (const CoverageCase& one : coverage.cases)
    for (std::size_t q = 0; q < names.size(); ++q) {
      const filters::Proportion inside = filters::proportion(one.inside[q], one.runs);
      table.row({to_string(one.colour), names[q], 100 * inside.value(), 100 * inside.lower_95,
                 100 * inside.upper_95, one.mean[q], one.mean_square[q], static_cast<double>(one.failed)});
    }
  table.note =
      "From, to: where the probability lies with 95 %, after so many runs. A run that failed counts as "
      "outside. Standard deviations are those that the intervals are made of, not knowing the noise exactly "
      "included.";
  return table;
}

std::string asked_text(CoverageModel model) {
  switch (model) {
    case CoverageModel::one_mode:
      return " with model beam on its first mode, from a bending stiffness 10 % off";
    case CoverageModel::three_modes:
      return " with model beam on its first three modes, from a bending stiffness 10 % off";
    case CoverageModel::mesh:
      return " with model beam on the whole mesh, from a bending stiffness 10 % off";
    default:
      return " without any option";
  }
}

}  // namespace

Results report(const Coverage& coverage) {
  const CoverageSettings& settings = coverage.settings;
  Results results;
  results.command = "efficiency";
  results.seed = settings.seed;
  results.configuration = coverage_configuration(settings);
  results.values["coverage"] = Json::array();
  for (const CoverageCase& one : coverage.cases)
    results.values["coverage"].push_back(coverage_values_of(one, keys_of(settings)));
  results.heading("The intervals of `beamid identify`");
  results.paragraph(fmt::format(
      "{} simulated records of each kind of noise: acceleration at the tip of a cantilever over {:g} cycles, "
      "damping ratio {:g} %; second and third mode with {:g} and {:g} % of the first one's amplitude; noise "
      "of {:g} % of it: white, behind a low-pass with its corner at 1.5 times the first frequency, or half "
      "white and half 1/f. Each identified as `beamid identify` does{}.",
      settings.runs, settings.cycles, 100 * settings.damping_ratio, 100 * settings.higher[0],
      100 * settings.higher[1], 100 * settings.noise, asked_text(settings.model)));
  results.table(table_of(coverage));
  return results;
}

namespace {

using Eigen::Index;

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

double at(const Eigen::VectorXd& values, Index i) {
  return values.size() > 0 ? values[i] : no_value;
}

std::vector<Cell> start_of_row(const EfficiencyCase& one) {
  return {fmt::format("{:g} %", 100.0 * one.damping_ratio),
          choice_text(one.filter, filters::filter_registry().find(one.filter.name).options),
          to_string(one.passes)};
}

void start_columns(Table& table) {
  table.column({"xi", "damping_ratio"}).column({"filter", "filter"}).column({"passes", "passes"});
}

}  // namespace

Table efficiency_table(const Efficiency& all) {
  Table table{"efficiency", "rms error / Cramer-Rao bound, and mean error"};
  start_columns(table);
  for (const char* constant : {"K", "C"}) {
    const std::string key = constant[0] == 'K' ? "stiffness" : "damping", name = constant;
    table.column({name + " rms / bound", key + "_rms_over_bound", "{:.3f}"})
        .column({name + " from", key + "_rms_over_bound_lower_95", "{:.3f}"})
        .column({name + " to", key + "_rms_over_bound_upper_95", "{:.3f}"})
        .column({name + " bias / bound", key + "_bias_over_bound", "{:.3f}"});
  }
  for (const EfficiencyCase& one : all.cases) {
    std::vector<Cell> row = start_of_row(one);
    for (Index i = 0; i < 2; ++i) {
      const double ratio = at(one.result.rms_over_bound, i),
                   half = quantile_95 * one.result.relative_rms_deviation;
      row.insert(row.end(),
                 {ratio, ratio * (1.0 - half), ratio * (1.0 + half), at(one.result.bias, i) / one.bound[i]});
    }
    table.row(std::move(row));
  }
  table.note = "From, to: 95 % interval, 1.96 / sqrt(2 runs). Runs that were lost are excluded.";
  return table;
}

Table consistency_table(const Efficiency& all) {
  Table table{"consistency", "What the filters report of their errors"};
  start_columns(table);
  table.column({"NEES", "nees", "{:.3f}"})
      .column({"band from", "nees_lower_999", "{:.3f}"})
      .column({"to", "nees_upper_999", "{:.3f}"})
      .column({"K covered [%]", "stiffness_coverage_percent", "{:.1f}"})
      .column({"C covered [%]", "damping_coverage_percent", "{:.1f}"})
      .column({"lost", "lost_runs", "{:.0f}"})
      .column({"of", "runs", "{:.0f}"})
      .column({"lost from [%]", "lost_lower_95_percent", "{:.2f}"})
      .column({"to [%]", "lost_upper_95_percent", "{:.2f}"});
  for (const EfficiencyCase& one : all.cases) {
    const filters::MonteCarloResult& result = one.result;
    const bool any = !result.coverage.empty();
    std::vector<Cell> row = start_of_row(one);
    row.insert(row.end(),
               {any ? result.nees : no_value, any ? result.nees_lower_999 : no_value,
                any ? result.nees_upper_999 : no_value, any ? 100.0 * result.coverage[0].value() : no_value,
                any ? 100.0 * result.coverage[1].value() : no_value,
                static_cast<double>(result.diverged.count), static_cast<double>(result.runs),
                100.0 * result.diverged.lower_95, 100.0 * result.diverged.upper_95});
    table.row(std::move(row));
  }
  table.note =
      "NEES per constant, 1 where consistent, with the band of 99.9 % of such experiments. Covered: by 95 % "
      "intervals. Lost: the filter failed, or K is off by 5 %, or C by half (and both by ten bounds).";
  return table;
}

}  // namespace beamid::experiments
