#include "experiments/studies/bounds/report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/config/description.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/studies/update/report.hpp"
#include "experiments/text/spelling.hpp"
#include "fem/assembly.hpp"

namespace beamid::experiments {
namespace {

const char* words_of(Excitation::Kind kind) {
  switch (kind) {
    case Excitation::Kind::release:
      return "after a release";
    case Excitation::Kind::step:
      return "under a constant force";
    case Excitation::Kind::impulse:
      return "after an impulse";
    case Excitation::Kind::harmonic:
      return "under a harmonic force";
    case Excitation::Kind::random:
      return "under a random force";
    case Excitation::Kind::base:
      return "under a motion of the base";
    case Excitation::Kind::table:
      return "under a force from a table";
    case Excitation::Kind::free:
      return "after a given start";
  }
  return "";
}

/// "after a release, under a random force and under a motion of the base".
std::string words_of_all(const Experiment& experiment) {
  std::vector<std::string> all{words_of(experiment.excitation.kind)};
  for (const Excitation& further : experiment.further_excitations) {
    const std::string one = words_of(further.kind);
    const std::string place =
        further.kind == Excitation::Kind::base ? "" : at_place_text(further.position, further.at);
    all.push_back(one + place);
  }
  return joined(all);
}

std::string test_text(const Experiment& experiment, const Identifiability& found) {
  const auto& frequencies = found.frequencies_hz;
  const bool several = !experiment.further_excitations.empty();
  std::string text = fmt::format(
      "Model {}, reduction {}: {} coordinate{}, {:.4g} Hz{}. A record of {:g} s at {:g} Hz {}{}.",
      found.model, found.reduction, found.coordinates, found.coordinates == 1 ? "" : "s", frequencies.front(),
      frequencies.size() > 1 ? fmt::format(" to {:.4g} Hz", frequencies.back()) : "", found.duration,
      found.sampling_rate, words_of_all(experiment),
      found.force_measured ? (several ? ", all of which are measured" : ", which is measured")
      : found.begin > 0.0
          ? fmt::format(", from {:g} s on, when {} ended", found.begin, several ? "all have" : "that has")
          : "");
  text += " Sensors:";
  for (std::size_t i = 0; i < found.sensors.size(); ++i) {
    const Sensor& sensor = found.sensors[i].sensor;
    text +=
        fmt::format("{} {} ({}{}, noise {:.3g} {}{})", i ? "," : "", sensor.name, to_string(sensor.quantity),
                    at_place_text(sensor.position.value_or(0.0), sensor.place), sensor.noise,
                    si_unit(sensor.quantity), found.sensors[i].assumed ? ", assumed" : "");
  }
  if (found.inputs) text += ". " + words(*found.inputs);
  return text + (found.inputs ? "" : ".") +
         " The start is unknown, the parameters requested have no prior, the noise is white.";
}

Attachment place_file(const Identifiability& found) {
  const Table table = sweep_table(found, found.places, "sensor_places", "", {"at [m]", "position_m"});
  return {{"sensor_places.csv"}, [csv = to_csv(table)](const std::filesystem::path& folder) {
            write_file(folder / "sensor_places.csv", csv);
          }};
}

}  // namespace

Results report(const Experiment& experiment, const Identifiability& found) {
  Results results;
  results.command = "identifiability";
  results.configuration = describe(experiment, {"excitation", "identifiability", "model", "reduction"});
  results.values = values(found);

  results.heading(experiment.title.empty() ? "What can be known" : experiment.title);
  if (const std::string text = twins_warning(experiment); !text.empty()) results.warning(text);
  results.paragraph(structure_text(experiment, experiment.elements,
                                   fem::assemble(experiment.structure, experiment.elements).size()));
  results.paragraph(test_text(experiment, found));
  results.table(bound_table(found));
  if (found.parameters.size() > 1) {
    results.table(combination_table(found));
    results.table(correlation_table(found));
  }
  results.table(sweep_table(found, found.lengths, "record_lengths", "Bounds over the length of the record",
                            {"duration [s]", "duration_s", "{:.4g}"}));
  results.table(sweep_table(
      found, found.rates, "sampling_rates", "Bounds over the sampling rate, the noise of a sample the same",
      {"rate [Hz]", "sampling_rate_hz", "{:.5g}"}, {"modes below half", "modes_below_half", "{:.0f}"}));
  if (!found.places.empty()) {
    results.table(place_table(found));
    results.table(sweep_table(found, found.numbers, "sensor_numbers",
                              "Bounds with further sensors like the first, each where it helps most",
                              {"sensors", "sensors", "{:.0f}"}, {"the last at [m]", "added_at_m", "{:.4g}"}));
    results.attachments.push_back(place_file(found));
  }
  for (const std::string& paragraph : words(found)) results.paragraph(paragraph);
  results.notes(found.notes);
  results.figures = figures(found);
  return results;
}

namespace {

using Eigen::Index, Eigen::VectorXd;

VectorXd finite_or_nan(const VectorXd& values) {
  return values.unaryExpr([](double value) { return std::isfinite(value) ? value : std::nan(""); });
}

Panel panel(const Identifiability& found, const BoundSweep& sweep, const std::string& title, Axis varied) {
  Panel result{title, std::move(varied), {"Cramér-Rao bound [%]", true}};
  constexpr Colour colours[] = {Colour::blue,   Colour::vermillion, Colour::green,
                                Colour::purple, Colour::orange,     Colour::sky};
  for (std::size_t j = 0; j < found.parameters.size(); ++j) {
    const VectorXd percent = finite_or_nan(sweep.percent.col(static_cast<Index>(j)));
    if (percent.array().isNaN().all()) continue;
    const Colour colour = colours[j % std::size(colours)];
    std::string name = found.parameters[j].name;
    std::replace(name.begin(), name.end(), '_', ' ');
    result.line(name, sweep.at, percent, colour);
  }
  return result;
}

}  // namespace

std::vector<Figure> figures(const Identifiability& found) {
  Figure record{"record",
                {panel(found, found.lengths, "length of the record", {"duration [s]", true}),
                 panel(found, found.rates, "sampling rate", {"sampling rate [Hz]", true})},
                1,
                2};
  record.caption = "Cramér-Rao bounds against the length of the record and the sampling rate.";
  std::vector<Figure> all{record};
  if (found.places.empty()) return all;
  Figure sensors{
      "sensors",
      {panel(found, found.places, "one sensor alone, moved along the beam", {"place [m]"}),
       panel(found, found.numbers, "sensors added, each at its best place", {"number of sensors"})},
      1,
      2};
  sensors.caption = "Cramér-Rao bounds against the place of a sensor, and against the number of sensors.";
  all.push_back(sensors);
  std::vector<Figure> drawn;
  for (Figure& figure : all) {
    std::erase_if(figure.panels, [](const Panel& one) { return one.curves.empty(); });
    figure.columns = static_cast<int>(figure.panels.size());
    if (!figure.panels.empty()) drawn.push_back(std::move(figure));
  }
  return drawn;
}

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
      "Bound: Cramer-Rao, on the standard deviation of any unbiased estimate. Others known: the bound with "
      "all other parameters known. 95 %: interval of an estimate at the bound.";
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

namespace {

using Eigen::Index;
using Json = nlohmann::ordered_json;

Json numbers(const Eigen::VectorXd& values) {
  Json json = Json::array();
  for (const double value : values) json.push_back(number_or_null(value));
  return json;
}

Json values(const ParameterBound& p) {
  return {{"unit", p.unit},
          {"value", p.value},
          {"verdict", to_string(p.verdict)},
          {"known_beforehand", p.nuisance},
          {"prior_deviation", p.nuisance ? Json(p.prior_deviation) : Json(nullptr)},
          {"bound", number_or_null(p.bound)},
          {"bound_percent", number_or_null(p.bound_percent())},
          {"percent_of", p.of_value ? "value" : "deviation"},
          {"conditional_bound", number_or_null(p.conditional_bound)},
          {"conditional_bound_percent", number_or_null(p.conditional_percent())},
          {"lower_95", number_or_null(p.lower_95)},
          {"upper_95", number_or_null(p.upper_95)}};
}

Json combinations(const Identifiability& found) {
  Json json{{"determined", Json::array()}, {"silent", Json::array()}};
  const auto weights = [&](const Eigen::VectorXd& weight) {
    Json named = Json::object();
    for (std::size_t j = 0; j < found.parameters.size(); ++j)
      named[found.parameters[j].name] = weight[static_cast<Index>(j)];
    return named;
  };
  for (Index k = 0; k < found.report.rank; ++k)
    json["determined"].push_back({{"deviation_percent", 100.0 / std::sqrt(found.report.eigenvalues[k])},
                                  {"weights", weights(found.report.combinations.col(k))}});
  const Eigen::MatrixXd silent = silent_combinations(found.report);
  for (const auto& change : silent.colwise()) json["silent"].push_back(weights(change));
  return json;
}

Json values(const Identifiability& found, const BoundSweep& sweep, const char* key, const char* beside = "") {
  Json json{{key, numbers(sweep.at)}, {"bound_percent", Json::object()}};
  for (std::size_t j = 0; j < found.parameters.size(); ++j)
    json["bound_percent"][found.parameters[j].name] = numbers(sweep.percent.col(static_cast<Index>(j)));
  if (sweep.beside.size() > 0) json[beside] = numbers(sweep.beside);
  return json;
}

}  // namespace

Json values(const Identifiability& found) {
  Json json{{"model", found.model},
            {"reduction", found.reduction},
            {"coordinates", found.coordinates},
            {"frequencies_hz", found.frequencies_hz},
            {"time_constant_s", found.slowest_decay > 0.0 ? Json(found.slowest_decay) : Json(nullptr)},
            {"force_measured", found.force_measured},
            {"begin_s", found.begin},
            {"duration_s", found.duration},
            {"sampling_rate_hz", found.sampling_rate},
            {"sensors", Json::array()},
            {"parameters", Json::object()}};
  if (found.inputs) json["inputs_between_samples"] = to_string(found.inputs->path);
  for (const Identifiability::UsedSensor& used : found.sensors)
    json["sensors"].push_back(
        {{"name", used.sensor.name},
         {"quantity", to_string(used.sensor.quantity)},
         {"position_m", used.sensor.place.empty() ? Json(used.sensor.position.value_or(0.0)) : Json(nullptr)},
         {"noise_si", used.sensor.noise},
         {"noise_assumed", used.assumed}});
  for (const ParameterBound& p : found.parameters) json["parameters"][p.name] = values(p);
  json["rank"] = found.report.rank;
  json["condition"] = number_or_null(found.report.condition);
  json["combinations"] = combinations(found);
  json["correlations"] = Json::array();
  for (const auto& row : found.report.correlations.rowwise())
    json["correlations"].push_back(numbers(row.transpose()));
  json["record_length"] = values(found, found.lengths, "duration_s");
  json["sampling_rate"] = values(found, found.rates, "sampling_rate_hz", "modes_below_half");
  if (!found.places.empty()) json["sensor_place"] = values(found, found.places, "position_m");
  if (!found.numbers.empty()) json["sensor_number"] = values(found, found.numbers, "sensors", "added_at_m");
  return json;
}

}  // namespace beamid::experiments
