// The page "many degrees of freedom" as text and tables.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "experiments/results/result_directory.hpp"
#include "experiments/studies/atlas/many_degrees.hpp"

namespace beamid::experiments {
namespace {

/// Smallest and largest of (u - truth) / (change by dt K) among the unknowns of damping that dt K changes.
std::pair<double, double> in_dt_k(const DegreesCase& one, double DegreesPoint::*of) {
  std::pair<double, double> range{std::nan(""), std::nan("")};
  for (std::size_t j = 0; j < one.points.size(); ++j) {
    const UnknownFamily::Part& part = one.family.parts[j];
    if (!part.damping || one.points[j].by_dt_k == 0.0) continue;
    const double value = (one.points[j].*of - part.value) / one.points[j].by_dt_k;
    range = {std::fmin(range.first, value), std::fmax(range.second, value)};
  }
  return range;
}

/// Errors [%] of the stiffness that the law makes most wrong.
std::pair<double, double> stiffness_errors(const DegreesCase& one) {
  std::pair<double, double> worst{0.0, 0.0};
  for (std::size_t j = 0; j < one.points.size(); ++j) {
    const UnknownFamily::Part& part = one.family.parts[j];
    const double law = 100.0 * (one.points[j].law - part.value) / part.size;
    if (!part.damping && std::abs(law) > std::abs(worst.first))
      worst = {law, 100.0 * (one.points[j].found - part.value) / part.size};
  }
  return worst;
}

Table damping_table(const DegreesPage& page) {
  Table table{"many_degrees_damping", "Error of C over dt K: smallest and largest of the unknowns"};
  table.column({"structure", "structure"})
      .column({"unknowns", "unknowns"})
      .column({"discretisation", "discretisation"})
      .column({"law", "smallest_of_law", "{:+.4f}"})
      .column({"to", "largest_of_law", "{:+.4f}"})
      .column({"EKF", "smallest", "{:+.4f}"})
      .column({"to", "largest", "{:+.4f}"})
      .column({"apart", "apart", "{:.1e}"});
  for (const DegreesCase& one : page.cases) {
    const auto law = in_dt_k(one, &DegreesPoint::law), found = in_dt_k(one, &DegreesPoint::found);
    table.row({one.family.structure, one.family.unknowns, one.scheme, law.first, law.second, found.first,
               found.second, one.apart_of_dt_k()});
  }
  return table;
}

Table stiffness_table(const DegreesPage& page) {
  Table table{"many_degrees_stiffness", "Error of the stiffness that is most wrong"};
  table.column({"structure", "structure"})
      .column({"unknowns", "unknowns"})
      .column({"discretisation", "discretisation"})
      .column({"law [%]", "stiffness_error_percent_of_law", "{:+.4g}"})
      .column({"EKF [%]", "stiffness_error_percent", "{:+.4g}"})
      .column({"apart", "apart", "{:.1e}"});
  for (const DegreesCase& one : page.cases) {
    const auto [law, found] = stiffness_errors(one);
    table.row({one.family.structure, one.family.unknowns, one.scheme, law, found, one.apart(false)});
  }
  return table;
}

/// @param all every unknown of several structures; else those of damping, of one structure under one scheme
Table unknowns_table(const char* name, const char* title, const std::vector<DegreesCase>& cases, bool all) {
  Table table{name, title};
  if (all) table.column({"structure", "structure"}).column({"discretisation", "discretisation"});
  table.column({"unknowns", "unknowns"})
      .column({"dt [s]", "interval_s", "{:.4g}"})
      .column({"unknown", "unknown"})
      .column({"unit", "unit"})
      .column({"true", "true_value", "{:.5g}"})
      .column({"dt K", "shift_by_dt_k", "{:+.5g}"});
  if (all) table.column({"first terms", "shift_of_first_terms", "{:+.5g}"});
  table.column({"law", "shift_of_law", "{:+.5g}"}).column({"EKF", "shift", "{:+.5g}"});
  for (const DegreesCase& one : cases)
    for (std::size_t j = 0; j < one.points.size(); ++j) {
      const UnknownFamily::Part& part = one.family.parts[j];
      if (!all && !part.damping) continue;
      const DegreesPoint& at = one.points[j];
      std::vector<Cell> row;
      if (all) row = {one.family.structure, one.scheme};
      const std::vector<Cell> described{one.family.unknowns, one.family.interval, part.name,
                                        part.unit,           part.value,          at.by_dt_k};
      row.insert(row.end(), described.begin(), described.end());
      if (all) row.emplace_back(at.first_terms - part.value);
      row.emplace_back(at.law - part.value);
      row.emplace_back(at.found - part.value);
      table.row(std::move(row));
    }
  return table;
}

Table cures_table(const DegreesPage& page) {
  Table table{"cures", "Forward Euler: largest error of a mode's damping, found and corrected [%]"};
  table.column({"structure", "structure"})
      .column({"dt [s]", "interval_s", "{:.4g}"})
      .column({"w dt [rad]", "highest_step_rad", "{:.3f}"})
      .column({"found", "damping_error_percent", "{:+.4g}"})
      .column({"less dt K", "damping_error_percent_less_dt_k", "{:+.4g}"})
      .column({"predicted", "predicted_remainder_percent", "{:+.4g}"})
      .column({"logarithm", "damping_error_percent_logarithm", "{:+.1e}"})
      .column({"exponential", "damping_error_percent_exponential", "{:+.1e}"});
  for (const DegreesCure& one : page.cures)
    table.row({one.structure, one.interval, one.highest_step, one.found, one.subtracted, one.predicted,
               one.behind, one.exact});
  return table;
}

Table noise_table(const DegreesPage& page) {
  Table table{"noisy_records", "Chain 3, noise of 0.1 % of the largest displacement, 20 seeds"};
  table.column({"filter", "filter"})
      .column({"discretisation", "discretisation"})
      .column({"unknown", "unknown"})
      .column({"law [dt K]", "law_over_dt_k", "{:+.4f}"})
      .column({"mean error [dt K]", "mean_error_over_dt_k", "{:+.4f}"})
      .column({"mean error / bound", "mean_error_over_bound", "{:+.3g}"})
      .column({"scatter / bound", "scatter_over_bound", "{:.2f}"});
  for (const DegreesNoise& one : page.noisy)
    table.row({one.filter, one.scheme, one.unknown, one.law, one.bias, one.bias_bound, one.scatter});
  return table;
}

}  // namespace

void add_degrees_page(const DegreesPage& page, Results& results) {
  results.heading("Many degrees of freedom");
  results.paragraph(
      "With displacements observed and no process noise a filter that moves by forward Euler finds C + dt K: "
      "every "
      "dashpot k dt too large, whatever its own value. Backward Euler takes the same away, symmetric schemes "
      "do "
      "neither. Chains of 3, 6 and 12 storeys (dt 2 ms, 1 % in the first mode), a steel frame of two storeys "
      "by "
      "groups of members and the beam S(11.8), whose highest mode turns by 0.2 rad a step. 'all entries' and "
      "'modes' hold whatever the law gives; of the others the law is projected by the information of the "
      "record. "
      "'apart': filter against law, of damping over dt K, of stiffness over its error.");
  results.table(damping_table(page));
  results.table(stiffness_table(page));
  results.table(unknowns_table(
      "fewer_damping_unknowns",
      "Chain 3 under forward Euler, fewer unknowns of damping: what is added to the true value",
      page.projections, false));
  results.table(cures_table(page));
  results.paragraph(
      "'less dt K' subtracts dt K, as found, from C: the remainder is -dt/2 C M^-1 C, 'predicted', -xi w dt "
      "of a "
      "mode's damping. 'logarithm' takes log(I + A dt) / dt of the matrices found and has no remainder where "
      "the "
      "unknowns hold every K and C. The exact discretisation needs no cure.");
  results.table(noise_table(page));
  results.paragraph(
      "Noise does not hide it: the mean error is many Cramer-Rao bounds, while the scatter over seeds is the "
      "bound.");
  const std::string all = to_csv(unknowns_table("many_degrees_unknowns", "", page.cases, true));
  results.attachments.push_back({{"many_degrees_unknowns.csv"}, [all](const std::filesystem::path& folder) {
                                   write_file(folder / "many_degrees_unknowns.csv", all);
                                 }});
}

}  // namespace beamid::experiments
