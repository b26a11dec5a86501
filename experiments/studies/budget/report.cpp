#include "experiments/studies/budget/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;
using BudgetParameter = double ParameterErrors::*;

Table budget_table(const Budget& budget, std::size_t number, BudgetParameter parameter, const char* symbol,
                   const char* key) {
  Table table{fmt::format("{}_budget_{}", key, number + 1),
              fmt::format("{}: the error of {}, cause by cause [% of {}]", budget.name, symbol, symbol)};
  table.column({"cause", "cause"})
      .column({"alone", "alone_percent", "{:+.4f}"})
      .column({"taken away", "without_percent", "{:+.4f}"})
      .column({"in sequence", "in_sequence_percent", "{:+.4f}"})
      .column({"average", "average_percent", "{:+.4f}"})
      .column({"what it is", "meaning"});
  ParameterErrors alone, without, sequence, average;
  for (std::size_t i = 0; i < cause_count; ++i) {
    const Contribution& c = budget.contributions[i];
    table.row({causes[i].name, c.alone.*parameter, c.without.*parameter, c.in_sequence.*parameter,
               c.average.*parameter, causes[i].on});
    alone = alone + c.alone, without = without + c.without;
    sequence = sequence + c.in_sequence, average = average + c.average;
  }
  const double change = budget.total.*parameter - budget.clean.*parameter;
  table.row({"interaction", change - alone.*parameter, change - without.*parameter,
             change - sequence.*parameter, change - average.*parameter, "what the causes do to each other"});
  table.row({"clean", budget.clean.*parameter, budget.clean.*parameter, budget.clean.*parameter,
             budget.clean.*parameter, "no cause at all"});
  table.row({"total", budget.total.*parameter, budget.total.*parameter, budget.total.*parameter,
             budget.total.*parameter, "every cause"});
  if (std::isnan(without.*parameter)) table.note = "-: with this cause taken away the filter loses the mode.";
  return table;
}

Table check_table(const std::vector<Budget>& budgets) {
  Table table{"closed_forms", "Single causes against their closed forms [%]"};
  table.column({"beam", "beam"})
      .column({"discretisation alone, C", "discretisation_damping_percent", "{:+.4f}"})
      .column({"closed form", "predicted_discretisation_damping_percent", "{:+.4f}"})
      .column({"reduction alone, K", "reduction_stiffness_percent", "{:+.5f}"})
      .column({"error of the mass", "predicted_reduction_stiffness_percent", "{:+.5f}"})
      .column({"noise alone, C", "noise_damping_percent", "{:+.4f}"})
      .column({"Cramer-Rao, 1 deviation", "noise_damping_bound_percent", "{:.4f}"});
  for (const Budget& b : budgets) {
    const auto alone = [&](Cause cause) { return b.contributions[index_of(cause)].alone; };
    table.row({b.name, alone(Cause::discretisation).damping,
               b.pipeline.discretisation(0.5 / b.pipeline.settings().sampling_rate).damping,
               alone(Cause::reduction).stiffness, b.pipeline.reduction().stiffness,
               alone(Cause::sensor_noise).damping, b.pipeline.noise_bound().damping});
  }
  table.note =
      "Alone, forward Euler runs at twice the stated rate, the clean pipeline's. At the stated rate: see "
      "'in sequence'.";
  return table;
}

Panel waterfall(const Budget& budget, BudgetParameter parameter, const char* symbol) {
  std::string axis;
  for (std::size_t i = 0; i < cause_count; ++i) axis += fmt::format("{} {}   ", i + 1, causes[i].label);
  Panel panel{fmt::format("{}: error of {}", budget.name, symbol),
              {axis + fmt::format("{} total", cause_count + 1), false,
               std::pair{0.3, static_cast<double>(cause_count) + 1.7}},
              {fmt::format("error of {} [%]", symbol)},
              {}};
  bool named[3] = {};
  const char* const labels[] = {"adds", "takes off", "total"};
  const Colour colours[] = {Colour::vermillion, Colour::blue, Colour::grey};
  const auto bar = [&](double at, double from, double to, int kind) {
    Curve curve{named[kind] ? "" : labels[kind],
                Eigen::Vector2d(at - 0.4, at + 0.4),
                Eigen::Vector2d::Zero(),
                CurveStyle::band,
                Eigen::Vector2d::Constant(std::min(from, to)),
                Eigen::Vector2d::Constant(std::max(from, to)),
                colours[kind]};
    named[kind] = true;
    panel.curves.push_back(std::move(curve));
  };
  Eigen::VectorXd edge(2 * cause_count + 2), level(2 * cause_count + 2);
  double sum = budget.clean.*parameter;
  for (std::size_t i = 0; i < cause_count; ++i) {
    const double part = budget.contributions[i].in_sequence.*parameter, at = static_cast<double>(i + 1);
    bar(at, sum, sum + part, part < 0.0 ? 1 : 0);
    sum += part;
    edge.segment<2>(static_cast<Eigen::Index>(2 * i)) << at - 0.4, at + 0.6;
    level.segment<2>(static_cast<Eigen::Index>(2 * i)).setConstant(sum);
  }
  edge.tail<2>() << cause_count + 0.6, cause_count + 1.4;
  level.tail<2>().setConstant(sum);
  bar(cause_count + 1.0, 0.0, sum, 2);
  panel.curves.push_back({"", edge, level, CurveStyle::line, {}, {}, Colour::black});
  return panel;
}

std::string budget_words(const Budget& budget, BudgetParameter parameter, const char* symbol) {
  const std::size_t first = largest(budget.contributions, &Contribution::average, parameter);
  std::vector<Contribution> others = budget.contributions;
  others[first].average = {};
  const std::size_t second = largest(others, &Contribution::average, parameter);
  return fmt::format(
      "{} errs by {:+.3g} %. The largest cause is {} ({}), {:+.3g} %; next comes {}, {:+.3g} %. Interaction "
      "beyond the causes alone: {:+.3g} %.",
      symbol, budget.total.*parameter, causes[first].name, causes[first].on,
      budget.contributions[first].average.*parameter, causes[second].name,
      budget.contributions[second].average.*parameter, budget.interaction.*parameter);
}

Json json_of(const ParameterErrors& errors) {
  return {{"stiffness_percent", errors.stiffness}, {"damping_percent", errors.damping}};
}

Json budget_values_of(const Budget& budget) {
  Json json{{"name", budget.name},
            {"frequency_hz", budget.pipeline.truth().frequency_hz()},
            {"damping_ratio", budget.pipeline.truth().damping_ratio()},
            {"mass_kg", budget.pipeline.truth().mass},
            {"stiffness_n_per_m", budget.pipeline.truth().stiffness},
            {"damping_n_s_per_m", budget.pipeline.truth().damping},
            {"total", json_of(budget.total)},
            {"clean", json_of(budget.clean)},
            {"interaction", json_of(budget.interaction)},
            {"filter_runs", budget.runs}};
  for (const BudgetParameter parameter : {&ParameterErrors::stiffness, &ParameterErrors::damping})
    json[parameter == &ParameterErrors::stiffness ? "largest_stiffness_cause" : "largest_damping_cause"] =
        causes[largest(budget.contributions, &Contribution::average, parameter)].name;
  for (std::size_t i = 0; i < cause_count; ++i) {
    const Contribution& c = budget.contributions[i];
    json["causes"][causes[i].name] = {{"alone", json_of(c.alone)},
                                      {"without", json_of(c.without)},
                                      {"in_sequence", json_of(c.in_sequence)},
                                      {"average", json_of(c.average)}};
  }
  const double rate = budget.pipeline.settings().sampling_rate;
  json["closed_forms"] = {
      {"reduction", json_of(budget.pipeline.reduction())},
      {"discretisation_at_stated_rate", json_of(budget.pipeline.discretisation(1.0 / rate))},
      {"discretisation_at_twice_the_rate", json_of(budget.pipeline.discretisation(0.5 / rate))},
      {"noise_bound", json_of(budget.pipeline.noise_bound())}};
  return json;
}

Json configuration_of(const PipelineSettings& s, int orders) {
  return {{"orders", orders},
          {"elements", s.elements},
          {"modes", s.damping_ratios.size()},
          {"deflection_m", s.deflection},
          {"duration_s", s.duration},
          {"sampling_rate_hz", s.sampling_rate},
          {"sensor_noise_m_per_s2", s.sensor_noise},
          {"sensor_bias_m_per_s2", s.sensor_bias},
          {"sensor_mass_kg", s.sensor_mass},
          {"amplitude_damping", s.amplitude_damping},
          {"high_pass_hz", s.high_pass_hz}};
}

}  // namespace

Results report(const std::vector<Budget>& budgets, int orders) {
  Results results;
  results.command = "budget";
  const PipelineSettings& settings = budgets.front().pipeline.settings();
  results.seed = settings.seed;
  results.configuration = configuration_of(settings, orders);
  results.heading("Error budget: what each cause costs");
  results.paragraph(fmt::format(
      "A beam is pulled by {:g} mm and released; its acceleration, {:g} s at {:g} Hz, becomes K and C. "
      "Assumed: noise {:g} m/s2, bias {:g} m/s2, {:g} g of sensor that nobody counted, damping {:g} % "
      "larger at the release's amplitude. The truth is the first mode.",
      1e3 * settings.deflection, settings.duration, settings.sampling_rate, settings.sensor_noise,
      settings.sensor_bias, 1e3 * settings.sensor_mass, 100.0 * settings.amplitude_damping));
  results.paragraph(fmt::format(
      "Alone: switched on in the clean pipeline. Taken away: what switching it off in the full one would "
      "remove. In sequence: one after the other from the beam to the filter, as the waterfall shows. "
      "Average: over {} orders. The last two add up to the total.",
      orders));
  for (std::size_t b = 0; b < budgets.size(); ++b) {
    const Budget& budget = budgets[b];
    results.heading(budget.name);
    results.paragraph(budget_words(budget, &ParameterErrors::stiffness, "K"));
    results.paragraph(budget_words(budget, &ParameterErrors::damping, "C"));
    results.table(budget_table(budget, b, &ParameterErrors::stiffness, "K", "stiffness"));
    results.table(budget_table(budget, b, &ParameterErrors::damping, "C", "damping"));
    Figure figure{fmt::format("waterfall_{}", b + 1), {}, 2, 1, 1200, 900};
    figure.panels = {waterfall(budget, &ParameterErrors::stiffness, "K"),
                     waterfall(budget, &ParameterErrors::damping, "C")};
    results.figures.push_back(std::move(figure));
    results.values["beams"].push_back(budget_values_of(budget));
  }
  results.heading("Against closed forms");
  results.table(check_table(budgets));
  return results;
}

}  // namespace beamid::experiments
