#include <fmt/format.h>

#include <limits>

#include "experiments/models/estimates.hpp"
#include "experiments/studies/efficiency/report.hpp"
#include "experiments/text/choice_text.hpp"

namespace beamid::experiments {
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
