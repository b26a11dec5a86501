#include "experiments/studies/check/report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/models/estimates.hpp"
#include "experiments/results/forest_plot.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr Index most_shown = 6;  // modes with a column of their own
constexpr std::size_t most_pairs = 8;

std::string label(const ModelCheck& check, const CheckedMode& mode) {
  return check.structures.size() > 1
             ? fmt::format("{}, mode {}", check.structures[mode.structure].name, mode.number)
             : fmt::format("mode {}", mode.number);
}

Table mode_table(const ModelCheck& check) {
  Table table{"modes", "Predicted and identified"};
  if (check.structures.size() > 1) table.column({"structure", "structure"});
  table.column({"mode", "mode", "{:.0f}"})
      .column({"predicted [Hz]", "predicted_hz", "{:.3f}"})
      .column({"identified [Hz]", "identified_hz", "{:.3f}"})
      .column({"95 % +- [Hz]", "half_interval_hz", "{:.2g}"})
      .column({"difference [%]", "difference_percent", "{:+.2f}"});
  const bool damped = std::any_of(check.modes.begin(), check.modes.end(), [](const CheckedMode& m) {
    return std::isfinite(m.predicted_damping_ratio);
  });
  const bool shaped = std::any_of(check.modes.begin(), check.modes.end(),
                                  [](const CheckedMode& m) { return std::isfinite(m.assurance); });
  if (damped) table.column({"predicted damping ratio [%]", "predicted_damping_ratio_percent", "{:.3f}"});
  table.column({"damping ratio [%]", "damping_ratio_percent", "{:.3f}"})
      .column({"95 % +- [%]", "damping_ratio_half_interval_percent", "{:.2g}"});
  if (shaped) table.column({"MAC", "mac", "{:.3f}"});
  for (const CheckedMode& mode : check.modes) {
    std::vector<Cell> row;
    if (check.structures.size() > 1) row.emplace_back(check.structures[mode.structure].name);
    row.insert(row.end(), {static_cast<double>(mode.number), mode.predicted_hz, mode.identified.frequency_hz,
                           quantile_95 * mode.identified.frequency_deviation_hz,
                           100 * (mode.identified.frequency_hz / mode.predicted_hz - 1)});
    if (damped) row.emplace_back(100 * mode.predicted_damping_ratio);
    row.insert(row.end(), {100 * mode.identified.damping_ratio,
                           100 * quantile_95 * mode.identified.damping_ratio_deviation});
    if (shaped) row.emplace_back(mode.assurance);
    table.row(std::move(row));
  }
  return table;
}

Table effect_table(const ModelCheck& check) {
  const Index shown = std::min(check.effect.rows(), most_shown);
  Table table{"effects", "What a change does to the frequencies [%]"};
  table.column({"candidate", "candidate"}).column({"change", "change"});
  for (Index i = 0; i < shown; ++i)
    table.column({label(check, check.modes[i]), fmt::format("effect_{}_percent", i + 1), "{:+.2f}"});
  for (std::size_t c = 0; c < check.candidates.size(); ++c) {
    const Candidate& candidate = check.candidates[c];
    std::vector<Cell> row{
        candidate.name,
        fmt::format("{:+.3g} {}", (candidate.unit == "%" ? 100 : 1) * candidate.plausible_upper,
                    candidate.unit)};
    for (Index i = 0; i < shown; ++i) row.emplace_back(100 * check.effect(i, static_cast<Index>(c)));
    table.row(std::move(row));
  }
  table.note = "First-order change for the largest plausible error of each quantity.";
  return table;
}

double change_number(const Candidate& c, double x) {
  return (c.unit == "%" ? 100 : 1) * x + 0.0;
}

/// Candidate, change and its 95 % interval, with what update remarks of a parameter.
std::vector<Cell> change_cells(const ModelCheck& check, const Explanation& e, std::size_t i) {
  const Candidate& c = check.candidates[e.candidates[i]];
  const bool interval = e.determined[i] && !(e.at_limit[i] && e.candidates.size() > 1);
  return {c.name,
          c.unit,
          change_number(c, e.change[static_cast<Index>(i)]),
          interval ? change_number(c, e.lower_95(i)) : std::nan(""),
          interval ? change_number(c, e.upper_95(i)) : std::nan(""),
          std::string(!e.determined[i] ? "not determined"
                      : e.at_limit[i]  ? "on its bound"
                                       : "")};
}

Table& add_change_columns(Table& table) {
  return table.column({"candidate", "candidate"})
      .column({"unit", "unit"})
      .column({"change", "change", "{:+.3g}"})
      .column({"95 % from", "lower_95", "{:+.3g}"})
      .column({"to", "upper_95", "{:+.3g}"})
      .column({"remark", "remark"});
}

std::string verdict_text(const Explanation& e) {
  std::string text = to_string(e.verdict);
  if (e.verdict == Explanation::Verdict::leaves_much && !e.plausible) text += ", implausible";
  return text;
}

double left_percent(const Explanation& e) {
  return 100 * e.left.norm() / std::sqrt(static_cast<double>(e.left.size()));
}

Table single_table(const ModelCheck& check) {
  Table table{"single_changes", "One change alone"};
  add_change_columns(table);
  if (check.structures.size() == 1) table.column({"would be", "value"});
  if (!check.right)
    table.column({"residual [%]", "left_percent", "{:.2f}"})
        .column({"chi^2", "chi_square", "{:.3g}"})
        .column({"verdict", "verdict"});
  for (const Explanation& e : check.single) {
    std::vector<Cell> row = change_cells(check, e, 0);
    const Candidate& c = check.candidates[e.candidates[0]];
    if (check.structures.size() == 1)
      row.emplace_back(
          fmt::format("{:.4g} {}", c.value(check.structures[0].structure, e.change[0]), c.value_unit));
    if (!check.right) row.insert(row.end(), {left_percent(e), e.chi_square, verdict_text(e)});
    table.row(std::move(row));
  }
  table.note =
      fmt::format("{}on its bound: the best fit lies at the edge of what is possible.",
                  check.right ? "" : "residual: root mean square of what remains of the frequencies; ");
  return table;
}

Table pair_table(const ModelCheck& check) {
  Table table{"pairs", "Two changes together"};
  table.column({"pair", "pair", "{:.0f}"});
  add_change_columns(table)
      .column({"residual [%]", "left_percent", "{:.2f}"})
      .column({"correlation", "correlation", "{:+.3f}"})
      .column({"verdict", "verdict"});
  for (std::size_t k = 0; k < std::min(most_pairs, check.pairs.size()); ++k) {
    const Explanation& e = check.pairs[k];
    for (std::size_t i = 0; i < 2; ++i) {
      std::vector<Cell> row{static_cast<double>(k + 1)};
      for (Cell& cell : change_cells(check, e, i)) row.push_back(std::move(cell));
      row.insert(row.end(), {left_percent(e), e.correlation, verdict_text(e)});
      table.row(std::move(row));
    }
  }
  if (check.pairs.size() > most_pairs)
    table.note =
        fmt::format("The {} best of {}; all of them in results.json.", most_pairs, check.pairs.size());
  if (check.pairs.size() < check.possible_pairs)
    table.note +=
        fmt::format(" Fitted were those of {} pairs that come nearest at first order.", check.possible_pairs);
  return table;
}

ForestSeries check_series(const ModelCheck& check, const std::string& name, const VectorXd& left,
                          Colour colour) {
  ForestSeries series{name, {}, {}, {}, colour};
  for (std::size_t i = 0; i < check.modes.size(); ++i) {
    const ObservedMode& mode = check.modes[i].identified;
    const double own =
        std::isfinite(mode.frequency_deviation_hz) ? mode.frequency_deviation_hz / mode.frequency_hz : 0;
    const double half = 100 * quantile_95 * std::hypot(own, check.settings.model_error);
    const double value = 100 * left[static_cast<Index>(i)];
    series.value.push_back(value);
    series.lower.push_back(value - half);
    series.upper.push_back(value + half);
  }
  return series;
}

// A row for each mode: as described, and after the best one and two changes.
Figure figure_of(const ModelCheck& check) {
  ForestPlot plot{"", "identified against predicted frequency [%], 95 % intervals", {}, {}};
  VectorXd described(static_cast<Index>(check.modes.size()));
  for (std::size_t i = 0; i < check.modes.size(); ++i) {
    plot.names.push_back(label(check, check.modes[i]));
    described[static_cast<Index>(i)] = check.modes[i].difference();
  }
  const auto named = [&](const Explanation& e) {
    std::string name = check.candidates[e.candidates[0]].label;
    if (e.candidates.size() > 1) name += " and " + check.candidates[e.candidates[1]].label;
    return name + " fitted";
  };
  plot.series.push_back(check_series(check, "as described", described, Colour::black));
  if (!check.right && !check.single.empty())
    plot.series.push_back(check_series(check, named(check.single[0]), check.single[0].left, Colour::blue));
  if (!check.right && !check.pairs.empty())
    plot.series.push_back(
        check_series(check, named(check.pairs[0]), check.pairs[0].left, Colour::vermillion));
  plot.reference = ForestReference{"as predicted", 0.0};
  Figure figure{"model_check", {forest_panel(plot)}};
  figure.height = forest_height(plot.names.size() * std::max<std::size_t>(1, plot.series.size() - 1), 1);
  figure.caption =
      "Identified against predicted frequencies: as described, and with the best changes fitted.";
  return figure;
}

/// Where shapes are compared, what they are trusted to.
std::string shapes_text(const ModelCheck& check) {
  if (std::none_of(check.modes.begin(), check.modes.end(),
                   [](const CheckedMode& mode) { return std::isfinite(mode.assurance); }))
    return "";
  return fmt::format(", each component of a predicted shape to {:.2g} % of the largest (--shape-error)",
                     100 * check.settings.shape_error);
}

}  // namespace

Results report(const ModelCheck& check) {
  Results results;
  results.command = "check";
  fill_model_check_values(check, results);
  for (const CheckedStructure& structure : check.structures)
    for (const std::string& warning : structure.warnings) results.warning(warning);
  for (const std::string& sentence : check.contradictions) results.warning(sentence);
  for (const std::string& sentence : conclusions(check)) results.paragraph(sentence);
  results.heading("The model against the modes identified");
  for (const CheckedMode& mode : check.modes)
    if (mode.far)
      results.paragraph(fmt::format(
          "The identified mode at {:.4g} Hz is taken for {}, {:+.0f} % from its prediction, since none is "
          "nearer.",
          mode.identified.frequency_hz, label(check, mode),
          100 * (mode.identified.frequency_hz / mode.predicted_hz - 1)));
  results.table(mode_table(check));
  if (!check.strays.empty()) {
    std::string text;
    for (const auto& [structure, mode] : check.strays)
      text += fmt::format("{}{:.4g} Hz{}", text.empty() ? "" : ", ", mode.frequency_hz,
                          check.structures.size() > 1 ? " of " + check.structures[structure].name : "");
    results.paragraph("Identified modes without a predicted counterpart, excluded: " + text +
                      ". A neighbour of the structure, motion in another plane, or no mode at all.");
  }
  results.paragraph(
      fmt::format("Each predicted frequency is trusted to {:.2g} % (one standard deviation, --model-error) "
                  "beside what the record does not determine{}.",
                  100 * check.settings.model_error, shapes_text(check)));
  results.heading("What would explain the difference");
  results.table(single_table(check));
  if (!check.right && !check.pairs.empty()) results.table(pair_table(check));
  results.table(effect_table(check));
  results.figures.push_back(figure_of(check));
  return results;
}

namespace {

using Json = nlohmann::ordered_json;

Json model_check_values_of(const ModelCheck& check, const Explanation& e) {
  Json json = Json::object();
  for (std::size_t i = 0; i < e.candidates.size(); ++i) {
    const Candidate& c = check.candidates[e.candidates[i]];
    json["changes"].push_back({{"candidate", c.name},
                               {"unit", c.unit == "%" ? "1" : c.unit},
                               {"estimate", e.change[i]},
                               {"standard_deviation", e.determined[i] ? Json(e.deviation[i]) : Json(nullptr)},
                               {"lower_95", e.determined[i] ? Json(e.lower_95(i)) : Json(nullptr)},
                               {"upper_95", e.determined[i] ? Json(e.upper_95(i)) : Json(nullptr)},
                               {"determined", static_cast<bool>(e.determined[i])},
                               {"at_limit", static_cast<bool>(e.at_limit[i])}});
  }
  if (e.candidates.size() > 1) json["correlation"] = e.correlation;
  json["chi_square"] = e.chi_square;
  json["left"] = std::vector<double>(e.left.begin(), e.left.end());
  json["freedom"] = e.freedom;
  json["starts"] = {{"made", e.starts}, {"reached_best", e.reached}};
  json["verdict"] = to_string(e.verdict);
  return json;
}

}  // namespace

void fill_model_check_values(const ModelCheck& check, Results& results) {
  results.configuration["model_error"] = check.settings.model_error;
  results.configuration["shape_error"] = check.settings.shape_error;
  Json& json = results.values;
  json["status"] = check.right ? "agrees" : "differs";
  json["chi_square"] = check.chi_square;
  json["numbers_measured"] = check.numbers;
  for (const CheckedMode& mode : check.modes)
    json["modes"].push_back({{"structure", check.structures[mode.structure].name},
                             {"mode", mode.number},
                             {"predicted_hz", mode.predicted_hz},
                             {"identified_hz", mode.identified.frequency_hz},
                             {"identified_standard_deviation_hz", mode.identified.frequency_deviation_hz},
                             {"predicted_damping_ratio", mode.predicted_damping_ratio},
                             {"damping_ratio", mode.identified.damping_ratio},
                             {"damping_ratio_standard_deviation", mode.identified.damping_ratio_deviation},
                             {"mac", mode.assurance},
                             {"far", mode.far}});
  for (const Candidate& c : check.candidates) {
    Json candidate{{"name", c.name},
                   {"unit", c.unit == "%" ? "1" : c.unit},
                   {"plausible", {c.plausible_lower, c.plausible_upper}}};
    json["candidates"].push_back(candidate);
  }
  for (const Explanation& e : check.single) json["single_changes"].push_back(model_check_values_of(check, e));
  for (const Explanation& e : check.pairs) json["pairs"].push_back(model_check_values_of(check, e));
  json["contradictions"] = check.contradictions;
  json["conclusions"] = conclusions(check);
}

}  // namespace beamid::experiments
