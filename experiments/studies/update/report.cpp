#include "experiments/studies/update/report.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "experiments/config/description.hpp"
#include "experiments/identify/update/mode_pairing.hpp"
#include "experiments/results/forest_plot.hpp"
#include "experiments/results/mode_figure.hpp"
#include "experiments/results/result_directory.hpp"

namespace beamid::experiments {
namespace {

constexpr std::size_t most_sets_shown = 6;

std::string starts_text(const UpdateStudy& study) {
  const Updating& updating = study.updating;
  std::string text =
      fmt::format("{} of {} starts reached the first set", updating.best().starts, updating.starts);
  std::size_t others = 0;
  for (const ParameterSet& set : updating.sets)
    if (set.as_well && &set != &updating.best()) others += set.starts;
  if (others > 0) text += fmt::format(", {} another one that fits as well", others);
  if (updating.ended_elsewhere > 0)
    text += fmt::format(", {} ended at a worse one", updating.ended_elsewhere);
  if (updating.failed > 0) text += fmt::format(", {} had no modes", updating.failed);
  return text + ".";
}

}  // namespace

Results report(const Experiment& experiment, const UpdateStudy& study) {
  Results results;
  results.command = "update";
  results.configuration = update_configuration(experiment, study);
  results.values = update_values(study);
  const auto [verdict, good] = update_verdict(study);
  if (good)
    results.paragraph(verdict);
  else
    results.warning(verdict, study.updating.refuted);
  for (const Objection& one : study.objections) results.object(one);
  results.heading("Parameters");
  results.table(parameter_table(study));
  for (const std::string& sentence : update_sentences(study)) results.paragraph(sentence);
  results.paragraph(described_text());
  results.heading("Modes");
  results.table(measured_mode_table(study));
  results.notes(study.data().remarks);
  results.heading("Other sets that fit as well");
  results.paragraph(starts_text(study));
  if (!study.updating.continuum()) results.paragraph(completeness_text(study));
  if (study.updating.sets.size() > 1) results.table(set_table(study, most_sets_shown, true));
  if (study.updating.continuum())
    results.paragraph("Of a continuum of sets that fit as well one is shown.");
  else if (study.updating.as_well() == 1)
    results.paragraph(study.complete() ? "No other set fits as well."
                                       : "No other set was found that fits as well.");
  if (study.updating.as_well() > 1 && !study.deciding.empty()) results.table(deciding_table(study.deciding));
  results.figures.push_back(update_figure(study, "updated_parameters"));
  add_swinging_modes(study, results);
  return results;
}

namespace {

using Eigen::Index;

constexpr Colour set_colours[] = {Colour::blue,   Colour::vermillion, Colour::green,
                                  Colour::purple, Colour::orange,     Colour::sky};

/// The sets that fit as well, as many as the figure shows.
std::vector<const ParameterSet*> drawn_sets(const UpdateStudy& study) {
  std::vector<const ParameterSet*> drawn;
  for (const ParameterSet& set : study.updating.sets)
    if (set.as_well && drawn.size() < std::size(set_colours)) drawn.push_back(&set);
  return drawn;
}

std::string set_mode_name(std::size_t set, std::size_t sets, Index mode, double frequency_hz) {
  return fmt::format("mode {} {}, {:.5g} Hz", mode + 1,
                     sets == 1 ? std::string("updated") : fmt::format("of set {}", set + 1), frequency_hz);
}

PointDetail set_detail(const UpdateStudy& study, const std::vector<const ParameterSet*>& sets,
                       std::size_t s) {
  const ParameterSet& set = *sets[s];
  PointDetail detail{sets.size() == 1 ? "updated" : fmt::format("set {}", s + 1),
                     {{"parameter", "value", "unit", "over described"}}};
  for (std::size_t j = 0; j < study.unknowns().size(); ++j) {
    const Unknown& unknown = study.unknowns()[j];
    const double value = set.values[static_cast<Index>(j)];
    detail.rows.push_back({unknown.name, fmt::format("{:.5g}", value), unknown.unit,
                           unknown.guess != 0.0 ? fmt::format("{:.3f}", value / unknown.guess) : "-"});
  }
  const double chi_square = set.fit.chi_square();
  detail.note = fmt::format("chi^2 {:.3g}; {} of {} starts ended here.", chi_square < 1e-6 ? 0.0 : chi_square,
                            set.starts, study.updating.starts);
  if (!study.model->described().system.mesh.nodes.empty()) {
    const Index mode = set.fit.value.pairs.front();
    detail.mode = set_mode_name(s, sets.size(), mode, set.fit.value.modes.frequency_hz[mode]);
  }
  return detail;
}

}  // namespace

void add_swinging_modes(const UpdateStudy& study, Results& results) {
  const fem::StructuralSystem& system = study.model->described().system;
  if (system.mesh.nodes.empty()) return;
  const std::vector<const ParameterSet*> sets = drawn_sets(study);
  if (sets.empty()) return;
  const auto most = std::max<std::size_t>(1, most_drawn_modes / (1 + sets.size()));
  const FoundModes described = study.model->found(study.model->described().values, false);
  std::vector<Eigen::VectorXd> shapes;
  std::vector<double> frequencies;
  std::vector<std::string> names;
  std::vector<std::optional<int>> beside;
  const auto add = [&](const Eigen::VectorXd& shape, double frequency_hz, std::string name) {
    shapes.push_back(shape);
    frequencies.push_back(frequency_hz);
    names.push_back(std::move(name));
    beside.emplace_back();
  };
  std::vector<FoundModes> found;
  for (const ParameterSet* set : sets) found.push_back(study.model->found(set->values, false));
  for (std::size_t i = 0; i < std::min(most, study.data().modes.size()); ++i) {
    const Index before = sets.front()->fit.value.pairs[i];
    const auto at = static_cast<int>(shapes.size() + sets.size());
    for (std::size_t s = 0; s < sets.size(); ++s) {
      const auto& value = sets[s]->fit.value;
      const Index mode = value.pairs[i];
      const double frequency_hz = value.modes.frequency_hz[mode];
      Eigen::VectorXd shape = found[s].shapes.col(mode);
      if (shape.dot(described.shapes.col(before)) < 0.0) shape = -shape;  // both swing to the same side
      add(shape, frequency_hz, set_mode_name(s, sets.size(), mode, frequency_hz));
      beside.back() = at;
    }
    const double frequency_hz = study.described.frequency_hz[before];
    add(described.shapes.col(before), frequency_hz,
        fmt::format("mode {} as described, {:.5g} Hz", before + 1, frequency_hz));
  }
  Eigen::MatrixXd matrix(system.size(), static_cast<Index>(shapes.size()));
  for (std::size_t k = 0; k < shapes.size(); ++k) matrix.col(static_cast<Index>(k)) = shapes[k];
  SwingModel model = mode_model(Picture(study.model->structure(), system), matrix,
                                Eigen::Map<const Eigen::VectorXd>(frequencies.data(), matrix.cols()));
  for (std::size_t k = 0; k < names.size(); ++k)
    model.modes[k].name = names[k], model.modes[k].beside = beside[k];
  results.attachments.push_back({{"modes.glb"}, [model](const std::filesystem::path& folder) {
                                   write_file(folder / "modes.glb", binary_gltf(model));
                                 }});
}

// A row for each parameter: the sets that fit as well, in parts of the description.
Figure update_figure(const UpdateStudy& study, const std::string& name) {
  ForestPlot plot{"", "parameter / described, 95 % intervals", {}, {}};
  for (const Unknown& unknown : study.unknowns()) plot.names.push_back(unknown.name);
  const std::vector<const ParameterSet*> sets = drawn_sets(study);
  for (std::size_t number = 0; number < sets.size(); ++number) {
    const ParameterSet& set = *sets[number];
    ForestSeries series{fmt::format("set {}", number + 1), {}, {}, {}, set_colours[number]};
    for (std::size_t j = 0; j < study.unknowns().size(); ++j) {
      const double described = study.unknowns()[j].guess,
                   value = set.values[static_cast<Index>(j)] / described;
      const UpdatedParameter& one = study.updating.parameters[j];
      const bool interval = number == 0 && one.determined;
      series.value.push_back(described != 0.0 ? value : std::nan(""));
      series.lower.push_back(interval ? one.lower_95 / described : value);
      series.upper.push_back(interval ? one.upper_95 / described : value);
    }
    series.details.push_back(set_detail(study, sets, number));
    plot.series.push_back(std::move(series));
  }
  if (sets.size() == 1) plot.series[0].label.clear();
  plot.reference = ForestReference{"as described", 1.0};
  Figure figure{name, {forest_panel(plot)}};
  figure.height = forest_height(plot.names.size() * std::max<std::size_t>(1, plot.series.size() / 2), 1);
  figure.caption = sets.size() == 1 ? "Updated parameters over those described."
                                    : "Parameters over those described, of every set that fits as well.";
  return figure;
}

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

namespace {

using Eigen::Index;
using Json = nlohmann::ordered_json;

Json set_values(const UpdateStudy& study, const ParameterSet& set) {
  Json json;
  for (std::size_t j = 0; j < study.unknowns().size(); ++j)
    json["parameters"][study.unknowns()[j].name] = set.values[static_cast<Index>(j)];
  json["chi_square"] = set.fit.chi_square() < 1e-12 ? 0.0 : set.fit.chi_square();
  json["fits_as_well"] = set.as_well;
  json["starts"] = set.starts;
  return json;
}

Json measured_values(const UpdateStudy& study) {
  Json json = Json::array();
  const auto& value = study.updating.best().fit.value;
  const Eigen::MatrixXd assurance = modal_assurances(study.data(), value.modes);
  for (std::size_t i = 0; i < study.data().modes.size(); ++i) {
    const Index k = value.pairs[i];
    json.push_back({{"mode", k + 1},
                    {"measured_hz", study.data().modes[i].frequency_hz},
                    {"standard_deviation_hz", study.residual->frequency_deviation(i)},
                    {"described_hz", study.described.frequency_hz[k]},
                    {"updated_hz", value.modes.frequency_hz[k]},
                    {"mac", number_or_null(assurance(static_cast<Index>(i), k))}});
  }
  return json;
}

}  // namespace

Json update_configuration(const Experiment& experiment, const UpdateStudy& study) {
  Json json = describe(experiment);
  json["modes_file"] = study.data().source;
  json["model_error"] = study.residual->trust().frequency;
  json["shape_error"] = study.residual->trust().shape;
  json["starts"] = study.updating.starts;
  return json;
}

Json update_values(const UpdateStudy& study) {
  const Updating& updating = study.updating;
  Json json;
  json["verdict"] = update_verdict(study).first;
  json["status"] = updating.refuted         ? "not explained"
                   : !updating.open.empty() ? "not determined"
                   : updating.as_well() > 1 ? "several sets"
                   : !updating.explains()   ? "poorly explained"
                                            : "one set";
  json["chi_square"] = updating.best().fit.chi_square() < 1e-12 ? 0.0 : updating.best().fit.chi_square();
  json["chi_square_limit_95"] = updating.limit;
  json["numbers_fitted"] = updating.independent;
  json["freedom"] = updating.freedom;
  json["intervals_widened_by"] = updating.widening;
  for (std::size_t j = 0; j < study.unknowns().size(); ++j) {
    const UpdatedParameter& one = updating.parameters[j];
    json["parameters"].push_back(
        {{"name", study.unknowns()[j].name},
         {"unit", study.unknowns()[j].unit},
         {"described", study.unknowns()[j].guess},
         {"estimate", one.value},
         {"standard_deviation", one.determined ? Json(one.deviation) : Json(nullptr)},
         {"lower_95", one.determined ? Json(one.lower_95) : Json(nullptr)},
         {"upper_95", one.determined ? Json(one.upper_95) : Json(nullptr)},
         {"determined", one.determined},
         {"on_bound", one.on_bound},
         {"ran_away", one.at_search_limit},
         {"prior", static_cast<bool>(study.model->asked().has_prior[j])}});
  }
  json["open_directions"] = Json::array();
  for (const OpenDirection& open : updating.open)
    json["open_directions"].push_back(
        {{"weights", std::vector<double>(open.weights.begin(), open.weights.end())},
         {"standard_deviation", number_or_null(open.deviation)}});
  for (const ParameterSet& set : updating.sets) json["sets"].push_back(set_values(study, set));
  json["sets_that_fit_as_well"] = updating.as_well();
  json["complete"] = study.complete();
  json["completeness"] = completeness_text(study);
  json["starts"] = {{"made", updating.starts},
                    {"reached_best", updating.best().starts},
                    {"ended_at_worse", updating.ended_elsewhere},
                    {"without_modes", updating.failed}};
  json["modes"] = measured_values(study);
  json["deciding_measurements"] = Json::array();
  for (const DecidingMeasurement& one : study.deciding)
    json["deciding_measurements"].push_back({{"kind", to_string(one.kind)},
                                             {"measurement", deciding_text(one)},
                                             {"predicted", one.predicted},
                                             {"least_distance_standard_deviations", one.separation}});
  return json;
}

}  // namespace beamid::experiments
