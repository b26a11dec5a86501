#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/identify/update/mode_pairing.hpp"
#include "experiments/studies/update/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

std::string remark_of(const UpdatedParameter& parameter) {
  return !parameter.determined       ? "not determined by these modes"
         : parameter.on_bound        ? "on its bound"
         : parameter.at_search_limit ? "ran away"
                                     : "";
}

}  // namespace

Table parameter_table(const UpdateStudy& study) {
  Table table{"parameters", ""};
  table.column({"parameter", "parameter"})
      .column({"unit", "unit"})
      .column({"described", "described", "{:.5g}"})
      .column({"updated", "updated", "{:.5g}"})
      .column({"95 % from", "lower_95", "{:.5g}"})
      .column({"to", "upper_95", "{:.5g}"})
      .column({"ratio", "ratio", "{:.3f}"})
      .column({"remark", "remark"});
  for (std::size_t j = 0; j < study.unknowns().size(); ++j) {
    const Unknown& unknown = study.unknowns()[j];
    const UpdatedParameter& updated = study.updating.parameters[j];
    const double nan = std::nan("");
    table.row({unknown.name, unknown.unit, unknown.guess, updated.value,
               updated.determined ? updated.lower_95 : nan, updated.determined ? updated.upper_95 : nan,
               unknown.guess != 0.0 ? updated.value / unknown.guess : nan, remark_of(updated)});
  }
  return table;
}

Table set_table(const UpdateStudy& study, std::size_t most, bool all) {
  const std::vector<ParameterSet>& sets = study.updating.sets;
  std::vector<const ParameterSet*> shown;
  for (const ParameterSet& set : sets)
    if (shown.size() < most && (all || set.as_well)) shown.push_back(&set);
  Table table{"sets", "Sets of parameters"};
  table.column({"parameter", "parameter"}).column({"unit", "unit"});
  for (std::size_t s = 0; s < shown.size(); ++s)
    table.column({fmt::format("set {}", s + 1), fmt::format("set_{}", s + 1), "{:.5g}"});
  for (std::size_t j = 0; j < study.unknowns().size(); ++j) {
    std::vector<Cell> row{study.unknowns()[j].name, study.unknowns()[j].unit};
    for (const ParameterSet* set : shown) row.emplace_back(set->values[static_cast<Index>(j)]);
    table.row(std::move(row));
  }
  const double best = study.updating.best().fit.chi_square();
  std::vector<Cell> chi{std::string("chi^2"), std::string("")},
      likely{std::string("likelihood / best"), std::string("")},
      starts{std::string("starts"), std::string("")};
  for (const ParameterSet* set : shown) {
    const double value = set->fit.chi_square();
    chi.emplace_back(value < 1e-6 ? 0.0 : value);
    likely.emplace_back(std::exp(-0.5 * std::max(0.0, value - best)) < 1e-99
                            ? 0.0
                            : std::exp(-0.5 * std::max(0.0, value < 1e-6 ? 0.0 : value - best)));
    starts.emplace_back(static_cast<double>(set->starts));
  }
  table.row(std::move(chi)).row(std::move(likely)).row(std::move(starts));
  const auto left = (all ? sets.size() : study.updating.as_well()) - shown.size();
  if (left > 0) table.note = fmt::format("{} more in results.json.", left);
  return table;
}

Table measured_mode_table(const UpdateStudy& study) {
  const auto& value = study.updating.best().fit.value;
  const Eigen::MatrixXd assurance = modal_assurances(study.data(), value.modes);
  const bool shaped = study.data().has_shapes();
  Table table{"modes", ""};
  table.column({"mode", "mode", "{:.0f}"})
      .column({"measured [Hz]", "measured_hz", "{:.4f}"})
      .column({"+- [Hz]", "standard_deviation_hz", "{:.2g}"})
      .column({"described [Hz]", "described_hz", "{:.4f}"})
      .column({"updated [Hz]", "updated_hz", "{:.4f}"})
      .column({"difference [+-]", "difference_in_standard_deviations", "{:+.2f}"});
  if (shaped) table.column({"MAC", "mac", "{:.4f}"});
  for (std::size_t i = 0; i < study.data().modes.size(); ++i) {
    const Index k = value.pairs[i];
    const double measured = study.data().modes[i].frequency_hz, updated = value.modes.frequency_hz[k],
                 deviation = study.residual->frequency_deviation(i),
                 difference = (updated - measured) / deviation;
    std::vector<Cell> row{
        static_cast<double>(k + 1),      measured, deviation,
        study.described.frequency_hz[k], updated,  std::abs(difference) < 1e-6 ? 0.0 : difference};
    if (shaped) row.emplace_back(assurance(static_cast<Index>(i), k));
    table.row(std::move(row));
  }
  table.note = fmt::format(
      "+-: one standard deviation of the measurement, with {:.2g} % of the frequency "
      "(--model-error).",
      100.0 * study.residual->trust().frequency);
  return table;
}

Table deciding_table(const std::vector<DecidingMeasurement>& deciding) {
  Table table{"deciding", "What would distinguish the sets"};
  table.column({"measurement", "measurement"})
      .column({"kind", "kind"})
      .column({"least distance [+-]", "separation_standard_deviations", "{:.1f}"});
  for (const DecidingMeasurement& one : deciding)
    table.row({deciding_text(one), std::string(to_string(one.kind)), one.separation});
  table.note = "Of any two sets the smallest distance of the predictions, in standard deviations.";
  return table;
}

}  // namespace beamid::experiments
