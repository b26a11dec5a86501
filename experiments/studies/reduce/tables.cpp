#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/studies/reduce/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

std::string number_of(const ReductionComparison& all, Index mode) {
  return fmt::format("{}", all.modes.modes.rigid + mode + 1);
}

// In per cent, without what rounding has left of a number that is zero.
double in_percent(double relative) {
  constexpr double rounding = 1e-11;
  return std::abs(relative) < rounding ? 0.0 : 100.0 * relative;
}

}  // namespace

std::string key_of(const std::string& label) {
  std::string key;
  for (const char letter : label)
    if (std::isalnum(static_cast<unsigned char>(letter)) != 0)
      key += letter;
    else if (!key.empty() && key.back() != '_')
      key += '_';
  return key;
}

Table reduction_table(const ReductionComparison& all) {
  Table table{"reductions", "Errors against the mesh [%]"};
  table.column({"reduction", "reduction"})
      .column({"r", "size", "{:.0f}"})
      .column({"n r", "basis_numbers", "{:.0f}"})
      .column({"static stiffness", "static_stiffness_error_percent", "{:+.3g}"})
      .column({"modal mass", "modal_mass_error_percent", "{:+.3g}"})
      .column({"freq. response", "frequency_response_error_percent", "{:.3g}"})
      .column({"worst [dB]", "frequency_response_worst_db", "{:+.3g}"})
      .column({"at [Hz]", "frequency_response_worst_hz", "{:.4g}"})
      .column({"decay displ.", "decay_displacement_error_percent", "{:.3g}"})
      .column({"decay accel.", "decay_acceleration_error_percent", "{:.3g}"});
  const auto n = static_cast<double>(all.system.size());
  for (const ComparedReduction& one : all.reductions) {
    const auto r = static_cast<double>(one.size);
    table.row({one.label, r, one.identity ? std::nan("") : n * r, in_percent(one.static_stiffness_error),
               in_percent(one.modal_mass_error), in_percent(one.response_error), one.worst_response,
               one.worst_response_hz, in_percent(one.displacement_error),
               in_percent(one.acceleration_error)});
  }
  table.note = fmt::format(
      "r: coordinates, n r: numbers in the shapes that carry them to the mesh, n = {}. Static stiffness and "
      "modal mass of the first mode: at the {}. Frequency response: magnitude there, {:.4g} to {:.4g} Hz, "
      "root mean square; worst: where it is furthest off. Decay: root mean square over {:.4g} s.",
      all.system.size(), all.observed.name, all.frequency_hz[0],
      all.frequency_hz[all.frequency_hz.size() - 1],
      all.release.samples > 0 ? all.release.time()[all.release.samples - 1] : 0.0);
  return table;
}

Table equivalent_table(const ReductionComparison& all) {
  Table table{"equivalents", fmt::format("At the {}", all.observed.name)};
  table.column({"model", "model"})
      .column({"static stiffness [N/m]", "static_stiffness_n_per_m", "{:.6g}"})
      .column({"modal mass of the first mode [kg]", "modal_mass_kg", "{:.6g}"});
  const auto add = [&](const std::string& name, const ModelBehaviour& behaviour) {
    table.row({name, behaviour.static_stiffness, behaviour.modal_mass});
  };
  add("mesh", all.behaviour);
  for (const ComparedReduction& one : all.reductions) add(one.label, one.behaviour);
  table.note = "Where r is 1 these are the equivalent stiffness and the equivalent mass.";
  return table;
}

Table frequency_table(const ReductionComparison& all) {
  Table table{"frequency_errors", "Frequency errors [%]"};
  table.column({"reduction", "reduction"});
  for (Index i = 0; i < all.compared(); ++i)
    table.column({fmt::format("mode {} {:.4f} Hz", number_of(all, i), all.mode_hz(i)),
                  "mode_" + number_of(all, i) + "_error_percent", "{:+.4g}"});
  for (const ComparedReduction& one : all.reductions) {
    std::vector<Cell> row{one.label};
    for (const double error : one.frequency_error) row.emplace_back(in_percent(error));
    table.row(std::move(row));
  }
  table.note = "-: no mode of the reduced model stands for this one (MAC above 1/2). 0: below 1e-9 %.";
  return table;
}

Table mac_table(const ReductionComparison& all) {
  Table table{"mac", "MAC, weighted with the mass"};
  table.column({"reduction", "reduction"});
  for (Index i = 0; i < all.compared(); ++i)
    table.column({"mode " + number_of(all, i), "mode_" + number_of(all, i) + "_mac", "{:.6f}"});
  table.column({"lowest CoMAC", "lowest_comac", "{:.6f}"}).column({"at [m]", "lowest_comac_m", "{:.4g}"});
  const VectorXd positions = all.system.node_positions();
  for (const ComparedReduction& one : all.reductions) {
    std::vector<Cell> row{one.label};
    for (const double value : one.mac) row.emplace_back(value);
    const LowestComac lowest = lowest_comac(one.comac);
    row.insert(row.end(), {lowest.value, lowest.point < 0 ? std::nan("") : positions[lowest.point]});
    table.row(std::move(row));
  }
  table.note =
      "With the mass modes are orthogonal, so that another mode has MAC 0 and one above 1/2 is alone in it; "
      "the plain MAC of deflections is in results.json. CoMAC: of the deflection, over the modes with MAC "
      "above 1/2, two at least (one alone agrees always); at every node in comac.csv.";
  return table;
}

Table comac_table(const ReductionComparison& all) {
  Table table{"comac", ""};
  const VectorXd positions = all.system.node_positions();
  Column at{"x [m]", "position_m"};
  at.cells.assign(positions.begin(), positions.end());
  table.column(at);
  for (const ComparedReduction& one : all.reductions) {
    Column column{one.label, key_of(one.label) + "_comac"};
    column.cells.assign(one.comac.begin(), one.comac.end());
    table.column(column);
  }
  return table;
}

std::optional<Table> significance_table(const ReductionComparison& all) {
  Index shown = 0;
  for (const ComparedReduction& one : all.reductions)
    shown = std::max(shown, std::min<Index>(6, one.significance.size()));
  if (shown == 0) return std::nullopt;
  Table table{"significance", "Significance of the shapes, as shares of the first"};
  table.column({"reduction", "reduction"}).column({"what", "what"}).column({"first", "first", "{:.4g}"});
  for (Index i = 1; i < shown; ++i)
    table.column({fmt::format("no. {}", i + 1), fmt::format("share_{}", i + 1), "{:.1e}"});
  for (const ComparedReduction& one : all.reductions) {
    if (one.significance.size() == 0) continue;
    std::vector<Cell> row{one.label, one.significance_name, one.significance[0]};
    for (Index i = 1; i < shown; ++i)
      row.emplace_back(i < one.significance.size() ? one.significance[i] / one.significance[0]
                                                   : std::nan(""));
    table.row(std::move(row));
  }
  table.note = "All of them, kept or not, are in results.json.";
  return table;
}

}  // namespace beamid::experiments
