#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/config/description.hpp"
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

namespace {

using Eigen::Index;
using Json = nlohmann::ordered_json;

Json percent_json(double relative) {
  return number_or_null(100.0 * relative);
}

Json modes_of(const ReductionComparison& all, const ComparedReduction& one) {
  Json modes = Json::array();
  for (Index i = 0; i < all.compared(); ++i)
    modes.push_back({{"mode", all.modes.modes.rigid + i + 1},
                     {"frequency_hz", number_or_null(one.frequency_hz[i])},
                     {"frequency_error_percent", percent_json(one.frequency_error[i])},
                     {"mac", number_or_null(one.mac[i])},
                     {"mac_of_deflections", number_or_null(one.deflection_mac[i])}});
  return modes;
}

Json significance_of(const ComparedReduction& one) {
  return {{"what", one.significance_name},
          {"values", std::vector<double>(one.significance.begin(), one.significance.end())}};
}

Json reduction_of(const ReductionComparison& all, const ComparedReduction& one) {
  Json json{{"name", one.label}, {"method", one.choice.name}, {"options", Json::object()}};
  for (const auto& [name, value] : one.choice.options.values())
    std::visit([&json, &name = name](const auto& held) { json["options"][name] = held; }, value);
  if (!one.choice.shape_file.empty()) json["shape_file"] = one.choice.shape_file;
  json["size"] = one.size;
  json["basis_numbers"] = one.identity ? Json(nullptr) : Json(one.size * all.system.size());
  json["modes"] = modes_of(all, one);
  const LowestComac lowest = lowest_comac(one.comac);
  json["lowest_comac"] = number_or_null(lowest.value);
  json["lowest_comac_m"] = lowest.point < 0 ? Json(nullptr) : Json(all.system.node_positions()[lowest.point]);
  json["static_stiffness_n_per_m"] = number_or_null(one.behaviour.static_stiffness);
  json["static_stiffness_error_percent"] = percent_json(one.static_stiffness_error);
  json["modal_mass_kg"] = number_or_null(one.behaviour.modal_mass);
  json["modal_mass_error_percent"] = percent_json(one.modal_mass_error);
  if (one.size == 1) {
    json["equivalent_stiffness_n_per_m"] = json["static_stiffness_n_per_m"];
    json["equivalent_mass_kg"] = json["modal_mass_kg"];
  }
  json["frequency_response_error_percent"] = percent_json(one.response_error);
  json["frequency_response_worst_db"] = number_or_null(one.worst_response);
  json["frequency_response_worst_hz"] = number_or_null(one.worst_response_hz);
  json["decay_displacement_error_percent"] = percent_json(one.displacement_error);
  json["decay_acceleration_error_percent"] = percent_json(one.acceleration_error);
  if (one.significance.size() > 0) json["significance"] = significance_of(one);
  return json;
}

}  // namespace

Json values(const ReductionComparison& all) {
  const ReleaseTest& release = all.release;
  Json json{{"elements", all.system.mesh.elements.size()},
            {"degrees_of_freedom", all.system.size()},
            {"observed_point", {{"name", all.observed.name}, {"position_m", all.observed.position}}},
            {"damping_assumed", all.damping_assumed},
            {"frequency_response",
             {{"from_hz", all.frequency_hz[0]}, {"to_hz", all.frequency_hz[all.frequency_hz.size() - 1]}}},
            {"decay", nullptr}};
  if (release.samples > 0)
    json["decay"] = {{"position_m", release.point.position},
                     {"deflection_m", release.deflection},
                     {"sampling_rate_hz", release.sampling_rate_hz},
                     {"duration_s", release.time()[release.samples - 1]},
                     {"modes_below_hz", release.limit_hz()}};
  json["mesh"] = {{"modes", Json::array()},
                  {"static_stiffness_n_per_m", number_or_null(all.behaviour.static_stiffness)},
                  {"modal_mass_kg", number_or_null(all.behaviour.modal_mass)}};
  for (Index i = 0; i < all.compared(); ++i)
    json["mesh"]["modes"].push_back(
        {{"mode", all.modes.modes.rigid + i + 1}, {"frequency_hz", all.mode_hz(i)}});
  json["reductions"] = Json::array();
  for (const ComparedReduction& one : all.reductions) json["reductions"].push_back(reduction_of(all, one));
  return json;
}

}  // namespace beamid::experiments
