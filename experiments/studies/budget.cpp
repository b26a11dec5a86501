// The error budget of a pipeline from acceleration to K and C: of the five beams, or of a user's own.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/identify/verdict/plausibility.hpp"
#include "experiments/results/results.hpp"
#include "experiments/studies/budget/budget.hpp"
#include "experiments/studies/paper/monte_carlo.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/text/choice.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {
namespace {

// Error budgets as a report.

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

/// @param budgets one at least, of the same assumptions @param orders of the average
Results report(const std::vector<Budget>& budgets, int orders) {
  Results results;
  results.command = "budget";
  const PipelineSettings& settings = budgets.front().pipeline.settings();
  results.seed = settings.seed;
  results.configuration = configuration_of(settings, orders);
  results.heading("Error budget: what each cause costs");
  results.paragraph(fmt::format(
      "A beam is pulled by {:g} mm and released; its acceleration, {:g} s at {:g} Hz, becomes K and C. "
      "Assumed: noise {:g} m/s2, bias {:g} m/s2, {:g} g of sensor that was not counted, damping {:g} % "
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

struct Named {
  std::string name;
  PipelineSettings settings;
};

std::vector<Named> five_beams(const PipelineSettings& common) {
  std::vector<Named> result;
  for (const paper::TestBeam& test : paper::test_beams) {
    const Release release = paper::release_of(test);
    PipelineSettings settings = common;
    settings.beam = release.beam;
    settings.elements = release.elements;
    settings.damping_ratios = Eigen::VectorXd::Constant(release.modes, release.higher_damping_ratio);
    settings.damping_ratios[0] = release.first_damping_ratio;
    settings.stream = paper::stream_of(static_cast<int>(result.size()), 0);
    result.push_back({test.name, settings});
  }
  return result;
}

/// The file's beam, damping, release, sampling rate and duration; 0.5 % where it states no damping.
Named described(const std::string& file, PipelineSettings settings) {
  const Experiment experiment = read_experiment(file);
  require_linear_storeys(experiment, "budget");
  const fem::Beam beam = at_place({file}, [&] { return experiment.structure.beam(); });
  settings.beam = beam;
  settings.elements = experiment.elements;
  const fem::StructuralSystem system = fem::assemble(beam, experiment.elements);
  const Eigen::VectorXd frequencies =
      fem::modes(system, std::min<Eigen::Index>(8, system.size())).angular_frequency;
  settings.damping_ratios = Eigen::VectorXd::Constant(frequencies.size(), 0.005);
  if (!std::holds_alternative<fem::Undamped>(experiment.damping))
    settings.damping_ratios = fem::damping_ratios(experiment.damping, frequencies);
  if (experiment.excitation.deflection) settings.deflection = std::abs(*experiment.excitation.deflection);
  settings.sampling_rate = experiment.format.sampling_rate.value_or(experiment.simulation.sampling_rate);
  settings.duration = std::max(experiment.simulation.duration, settings.duration);
  return {experiment.title.empty() ? file : experiment.title, settings};
}

class BudgetStudy final : public Study {
 public:
  explicit BudgetStudy(const filters::Options& options) {
    const double seed = options.number("seed"), orders = options.number("orders");
    if (!(seed >= 0.0 && seed == std::floor(seed) && seed < 0x1p53))
      throw std::invalid_argument("seed must be a whole number from 0");
    if (!(orders >= 2.0 && orders <= 1000.0 && std::fmod(orders, 2.0) == 0.0))
      throw std::invalid_argument("orders must be an even number from 2 to 1000");
    orders_ = static_cast<int>(orders);
    PipelineSettings common;
    common.seed = static_cast<std::uint64_t>(seed);
    common.sensor_noise = options.number("noise");
    common.sensor_bias = options.number("bias");
    common.sensor_mass = options.number("sensor_mass");
    common.amplitude_damping = options.number("amplitude_damping");
    if (!(common.sensor_noise > 0.0)) throw std::invalid_argument("noise must be above 0 m/s2");
    if (!std::isfinite(common.sensor_bias)) throw std::invalid_argument("bias must be finite");
    if (!(common.sensor_mass >= 0.0)) throw std::invalid_argument("sensor_mass must not be negative");
    if (!(common.amplitude_damping >= 0.0))
      throw std::invalid_argument("amplitude_damping must not be negative");
    config_ = options.text("config");
    beams_ = config_.empty() ? five_beams(common) : std::vector<Named>{described(config_, common)};
  }

  Results run(const Progress& progress) const override {
    std::vector<Budget> budgets;
    for (std::size_t i = 0; i < beams_.size(); ++i) {
      const std::string part = beams_.size() > 1 ? fmt::format("beam {} of {}, ", i + 1, beams_.size()) : "";
      budgets.push_back(make_budget(beams_[i].name, beams_[i].settings, orders_,
                                    [&](const std::string& what) { progress(part + what); }));
    }
    Results results = report(budgets, orders_);
    warn_of_file(results, config_);
    return results;
  }

 private:
  std::vector<Named> beams_;
  int orders_ = 2;
  std::string config_;
};

const bool budget_registered = study_registry().add(
    {"budget",
     "what each cause, from the beam to the filter, contributes to the errors of K and C",
     "[inverse2009], [shapley1953]",
     {{"seed", 2009.0, "", "seed of the sensor noise; the same seed gives the same bytes"},
      {"orders", 2.0, "", "number of orders of the causes to average over; even"},
      {"noise", 0.05, "m/s2", "standard deviation of the accelerometer's white noise"},
      {"bias", 0.02, "m/s2", "its constant offset (assumed)"},
      {"sensor_mass", 0.002, "kg", "of sensor and cable that the model does not count (assumed)"},
      {"amplitude_damping", 0.02, "", "growth of the damping at the amplitude of the release (assumed)"},
      {"config", std::string(), "", "experiment file of another beam; by default the study's five"}},
     {},
     [](const filters::Options& options) { return std::make_unique<BudgetStudy>(options); }});

}  // namespace

}  // namespace beamid::experiments
