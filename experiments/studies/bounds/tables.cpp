#include <fmt/format.h>

#include <cmath>

#include "experiments/studies/bounds/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

// The table prints NaN as "-": not determined.
double finite_or_nan(double value) {
  return std::isfinite(value) ? value : std::nan("");
}

// Weights with the largest 1, rounding left out.
Eigen::VectorXd weights(const filters::InformationReport& report, Index k) {
  constexpr double rounding = 5e-5;  // in the digits printed
  const Eigen::VectorXd column = report.combinations.col(k);
  const Eigen::VectorXd scaled = column / column.cwiseAbs().maxCoeff();
  return (scaled.array().abs() < rounding).select(0.0, scaled);
}

}  // namespace

Table bound_table(const Identifiability& found) {
  Table table{"parameters", "The least standard deviation with which each parameter can be known"};
  table.column({"parameter", "parameter"})
      .column({"unit", "unit"})
      .column({"value", "value", "{:.5g}"})
      .column({"bound", "bound", "{:.2g}"})
      .column({"[%]", "bound_percent", "{:.2g}"})
      .column({"others known [%]", "conditional_bound_percent", "{:.2g}"})
      .column({"95 % from", "lower_95", "{:.6g}"})
      .column({"to", "upper_95", "{:.6g}"})
      .column({"verdict", "verdict"});
  bool of_deviation = false;
  for (const ParameterBound& p : found.parameters) {
    of_deviation = of_deviation || !p.of_value;
    table.row({p.name, p.unit, p.value, finite_or_nan(p.bound), finite_or_nan(p.bound_percent()),
               finite_or_nan(p.conditional_percent()), finite_or_nan(p.lower_95), finite_or_nan(p.upper_95),
               p.nuisance ? "known beforehand" : to_string(p.verdict)});
  }
  table.note =
      "Bound: Cramer-Rao, on the standard deviation of any unbiased estimate. Others known: the same were "
      "all other parameters known. 95 %: what an interval from the best estimate would be.";
  if (of_deviation)
    table.note += " Of a parameter that is zero per cent are of its prior standard deviation.";
  return table;
}

Table combination_table(const Identifiability& found) {
  Table table{"combinations", "Combinations of parameters, best known first"};
  table.column({"known to [%]", "bound_percent", "{:.2g}"});
  for (const ParameterBound& p : found.parameters) table.column({p.name, p.name, "{:+.4f}"});
  const auto add = [&](double bound, const Eigen::VectorXd& weight) {
    std::vector<Cell> cells{bound};
    for (const double w : weight) cells.emplace_back(w);
    table.row(std::move(cells));
  };
  for (Index k = 0; k < found.report.rank; ++k) {
    const double largest = found.report.combinations.col(k).cwiseAbs().maxCoeff();
    add(100.0 / (largest * std::sqrt(found.report.eigenvalues[k])), weights(found.report, k));
  }
  const Eigen::MatrixXd silent = silent_combinations(found.report);
  for (const auto& change : silent.colwise()) add(std::nan(""), change);
  table.note =
      "Each row: the sum of the parameters' relative changes with these weights. \"-\": such a change does "
      "not alter the record.";
  return table;
}

Table correlation_table(const Identifiability& found) {
  Table table{"correlations", "Correlations of the best estimates"};
  table.column({"parameter", "parameter"});
  for (const ParameterBound& p : found.parameters) table.column({p.name, p.name, "{:+.4f}"});
  for (std::size_t i = 0; i < found.parameters.size(); ++i) {
    std::vector<Cell> cells{found.parameters[i].name};
    for (const double c : found.report.correlations.row(static_cast<Index>(i))) cells.emplace_back(c);
    table.row(std::move(cells));
  }
  if (found.report.rank < found.report.correlations.rows())
    table.note = "Of what is determined: what is not is held fixed.";
  return table;
}

Table sweep_table(const Identifiability& found, const BoundSweep& sweep, const std::string& name,
                  const std::string& title, const Column& varied, const Column& beside) {
  Table table{name, title};
  const bool two = sweep.beside.size() > 0;
  table.column(varied);
  if (two) table.column(beside);
  for (const ParameterBound& p : found.parameters)
    table.column({p.name + " [%]", p.name + "_percent", "{:.3g}"});
  for (Index i = 0; i < sweep.at.size(); ++i) {
    std::vector<Cell> cells{sweep.at[i]};
    if (two) cells.emplace_back(sweep.beside[i]);
    for (const double percent : sweep.percent.row(i)) cells.emplace_back(finite_or_nan(percent));
    table.row(std::move(cells));
  }
  return table;
}

Table place_table(const Identifiability& found) {
  Table table{"best_places", "Where one sensor like the first, alone, is best placed"};
  table.column({"parameter", "parameter"})
      .column({"best at [m]", "position_m", "{:.4g}"})
      .column({"bound there [%]", "bound_percent", "{:.3g}"})
      .column({"worst at [m]", "worst_position_m", "{:.4g}"})
      .column({"bound there [%]", "worst_bound_percent", "{:.3g}"});
  for (std::size_t j = 0; j < found.parameters.size(); ++j) {
    Index best = 0, worst = 0;
    const Eigen::VectorXd percent = found.places.percent.col(static_cast<Index>(j));
    percent.minCoeff(&best);
    percent.maxCoeff(&worst);
    const bool known = std::isfinite(percent[best]);
    table.row({found.parameters[j].name, known ? found.places.at[best] : std::nan(""),
               finite_or_nan(percent[best]), found.places.at[worst], finite_or_nan(percent[worst])});
  }
  return table;
}

}  // namespace beamid::experiments
