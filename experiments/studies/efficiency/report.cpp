#include "experiments/studies/efficiency/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/models/estimates.hpp"
#include "experiments/text/choice_text.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

std::string label_of(const Choice& filter) {
  return choice_text(filter, filters::filter_registry().find(filter.name).options);
}

// One constant after one way to pass: a point with its 95 % interval per filter and damping ratio.
Panel panel(const Efficiency& all, Passes passes, Index constant) {
  const EfficiencySettings& settings = all.settings;
  Panel panel{fmt::format("{}, passes: {}", constant == 0 ? "stiffness K" : "damping C", to_string(passes)),
              {"damping ratio [%]", true},
              {"rms error / Cramér-Rao bound", true},
              {}};
  const auto [least, most] =
      std::minmax_element(settings.damping_ratios.begin(), settings.damping_ratios.end());
  const Eigen::Vector2d ends(50.0 * *least, 200.0 * *most);
  panel.curves.push_back({"0.95 to 1.05", ends, Eigen::Vector2d::Ones(), CurveStyle::band,
                          Eigen::Vector2d::Constant(0.95), Eigen::Vector2d::Constant(1.05), Colour::grey});
  const auto count = static_cast<double>(settings.filters.size());
  for (std::size_t f = 0; f < settings.filters.size(); ++f) {
    std::vector<const EfficiencyCase*> shown;
    for (std::size_t i = f; i < all.cases.size(); i += settings.filters.size())
      if (all.cases[i].passes == passes && all.cases[i].result.rms_over_bound.size() > 0)
        shown.push_back(&all.cases[i]);
    VectorXd x(shown.size()), y(shown.size()), half(shown.size());
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const auto k = static_cast<Index>(i);
      const double aside = (static_cast<double>(f) + 0.5) / count - 0.5;  // side by side
      x[k] = 100.0 * shown[i]->damping_ratio * std::exp2(1.2 * aside);
      y[k] = shown[i]->result.rms_over_bound[constant];
      half[k] = std::min(quantile_95 * shown[i]->result.relative_rms_deviation, 0.95) * y[k];
    }
    if (shown.empty()) continue;
    panel.curves.push_back({label_of(settings.filters[f]), x, y,
                            f % 2 == 0 ? CurveStyle::points : CurveStyle::open_points, y - half, y + half});
  }
  return panel;
}

nlohmann::ordered_json interval(const filters::Proportion& share) {
  return {{"count", share.count},
          {"runs", share.runs},
          {"lower_95", share.lower_95},
          {"upper_95", share.upper_95}};
}

nlohmann::ordered_json efficiency_values_of(const EfficiencyCase& one) {
  const filters::MonteCarloResult& result = one.result;
  nlohmann::ordered_json json{{"filter", label_of(one.filter)},     {"passes", to_string(one.passes)},
                              {"damping_ratio", one.damping_ratio}, {"runs", result.runs},
                              {"lost", interval(result.diverged)},  {"lost_seeds", result.diverged_seeds}};
  const char *names[] = {"stiffness", "damping"}, *units[] = {"_n_per_m", "_n_s_per_m"};
  for (Index i = 0; i < 2; ++i) {
    nlohmann::ordered_json& constant = json[names[i]];
    const auto with_unit = [&](const char* name) { return std::string(name) + units[i]; };
    constant[with_unit("truth")] = i == 0 ? one.truth.stiffness : one.truth.damping;
    constant[with_unit("bound")] = one.bound[i];
    constant[with_unit("lost_beyond")] = one.largest[i];
    if (result.coverage.empty()) continue;
    constant[with_unit("bias")] = result.bias[i];
    constant[with_unit("bias_standard_error")] = result.bias_deviation[i];
    constant[with_unit("rms")] = result.rms[i];
    constant["rms_over_bound"] = result.rms_over_bound[i];
    constant["rms_over_deviation"] = result.rms_over_deviation[i];
    constant["coverage"] = interval(result.coverage[static_cast<std::size_t>(i)]);
  }
  if (result.coverage.empty()) return json;
  json["rms_relative_standard_error"] = result.relative_rms_deviation;
  json["nees"] = {{"mean", result.nees},
                  {"lower_999", result.nees_lower_999},
                  {"upper_999", result.nees_upper_999},
                  {"consistent", result.consistent()}};
  return json;
}

nlohmann::ordered_json efficiency_configuration(const EfficiencySettings& settings) {
  const DecaySettings& decay = settings.decay;
  nlohmann::ordered_json json;
  for (const Choice& filter : settings.filters) json["filters"].push_back(label_of(filter));
  json["damping_ratios"] = settings.damping_ratios;
  for (const Passes passes : settings.passes) json["passes"].push_back(to_string(passes));
  json["guess"] = decay.guess == Guess::drawn ? "drawn" : "ends";
  json["runs"] = settings.runs;
  json["sampled_runs"] = settings.sampled_runs;
  json["mass_kg"] = decay.mass;
  json["frequency_hz"] = decay.frequency_hz;
  json["amplitude_m"] = decay.amplitude;
  json["phase_rad"] = decay.phase;
  json["noise_over_amplitude"] = decay.noise;
  json["samples_per_cycle"] = decay.samples_per_cycle;
  json["cycles"] = decay.cycles;
  json["time_constants"] = decay.time_constants;
  return json;
}

}  // namespace

Figure efficiency_figure(const Efficiency& all) {
  Figure figure{"efficiency_plot", {}, static_cast<int>(all.settings.passes.size()), 2, 1100};
  for (const Passes passes : all.settings.passes)
    for (const Index constant : {0, 1}) figure.panels.push_back(panel(all, passes, constant));
  return figure;
}

Results report(const Efficiency& all) {
  const DecaySettings& decay = all.settings.decay;
  Results results;
  results.command = "efficiency";
  results.seed = all.settings.seed;
  results.configuration = efficiency_configuration(all.settings);
  results.values["cases"] = nlohmann::ordered_json::array();
  for (const EfficiencyCase& one : all.cases) results.values["cases"].push_back(efficiency_values_of(one));
  results.heading("Filters against the Cramer-Rao bound");
  results.paragraph(fmt::format(
      "Free decays of an oscillator of {:g} Hz, displacement read {:g} times a cycle over {:g} cycles or "
      "{:g} time constants with white noise of {:g} % of the amplitude. Initial state unknown; K and C "
      "guessed at {} half {} twice the truth.",
      decay.frequency_hz, decay.samples_per_cycle, decay.cycles, decay.time_constants, 100.0 * decay.noise,
      decay.guess == Guess::drawn ? "between" : "either", decay.guess == Guess::drawn ? "and" : "or"));
  results.table(efficiency_table(all));
  results.table(consistency_table(all));
  results.figures = {efficiency_figure(all)};
  return results;
}

}  // namespace beamid::experiments
