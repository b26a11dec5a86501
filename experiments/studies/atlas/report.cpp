#include "experiments/studies/atlas/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "experiments/results/file.hpp"
#include "experiments/studies/paper/numerical_validation.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

double stiffness_bias(const std::optional<Bias>& bias) {
  return bias ? bias->stiffness_percent : none;
}
double damping_bias(const std::optional<Bias>& bias) {
  return bias ? bias->damping_percent : none;
}

Table own_table(const Atlas& atlas) {
  Table table{"own_step", "What each discretisation does at this step: closed form, and the filter"};
  table.column({"discretisation", "discretisation"})
      .column({"K, closed form [%]", "predicted_stiffness_error_percent", "{:+.5g}"})
      .column({"K, EKF [%]", "stiffness_error_percent", "{:+.5g}"})
      .column({"C, closed form [%]", "predicted_damping_error_percent", "{:+.5g}"})
      .column({"C, EKF [%]", "damping_error_percent", "{:+.5g}"});
  for (const AtlasPoint& p : atlas.own)
    table.row({p.scheme, stiffness_bias(p.predicted), stiffness_bias(p.measured), damping_bias(p.predicted),
               damping_bias(p.measured)});
  return table;
}

// Samples per period at least, for C within so many per cent.
Table harmless_table(const Atlas& atlas, const char* name, double limit) {
  Table table{name, fmt::format("Samples per period from which the error of C stays within {:g} %", limit)};
  table.column({"discretisation", "discretisation"});
  for (const double ratio : atlas.settings.damping_ratios)
    table.column({fmt::format("xi = {:g} %", 100.0 * ratio),
                  fmt::format("samples_per_period_at_ratio_{:g}", ratio), "{:.3g}"});
  for (const std::string& scheme : paper::compared_schemes()) {
    std::vector<Cell> row{scheme};
    for (const double ratio : atlas.settings.damping_ratios) {
      const double step = harmless_step(scheme, ratio, limit);
      row.emplace_back(std::isfinite(step) ? 2.0 * std::numbers::pi / step : 2.0);
    }
    table.row(std::move(row));
  }
  return table;
}

Table map_table(const Atlas& atlas) {
  Table table{"map", ""};
  table.column({"discretisation", "discretisation"})
      .column({"xi", "damping_ratio"})
      .column({"w dt [rad]", "step_rad"})
      .column({"K [%]", "predicted_stiffness_error_percent"})
      .column({"C [%]", "predicted_damping_error_percent"})
      .column({"K, EKF [%]", "stiffness_error_percent"})
      .column({"C, EKF [%]", "damping_error_percent"});
  for (const AtlasPoint& p : atlas.map)
    table.row({p.scheme, p.damping_ratio, p.step, stiffness_bias(p.predicted), damping_bias(p.predicted),
               stiffness_bias(p.measured), damping_bias(p.measured)});
  return table;
}

Panel panel_of(const Atlas& atlas, const std::string& scheme, bool of_damping) {
  Panel panel{scheme,
              {"ω Δt [rad]", true, std::pair{1e-3, 2.0}},
              {of_damping ? "|error of C| [%]" : "|error of K| [%]", true, std::pair{1e-6, 1e5}},
              {}};
  panel.legend = Legend::bottom_right;
  for (const double ratio : atlas.settings.damping_ratios) {
    std::vector<double> x, y, at, measured;
    for (const AtlasPoint& p : atlas.map) {
      if (p.scheme != scheme || p.damping_ratio != ratio) continue;
      const auto value = [&](const std::optional<Bias>& bias) {
        return std::abs(of_damping ? damping_bias(bias) : stiffness_bias(bias));
      };
      x.push_back(p.step);
      y.push_back(value(p.predicted) > 1e-9 ? value(p.predicted) : none);
      if (p.measured) at.push_back(p.step), measured.push_back(value(p.measured));
    }
    const auto vector = [](const std::vector<double>& values) {
      return Eigen::VectorXd(
          Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
    };
    panel.curves.push_back({fmt::format("ξ = {:g} %", 100.0 * ratio), vector(x), vector(y)});
    panel.curves.push_back(
        {"", vector(at), vector(measured), CurveStyle::open_points, {}, {}, Colour::black});
  }
  return panel;
}

Figure figure_of(const Atlas& atlas, const char* name, bool of_damping) {
  Figure figure{name, {}, 3, 2};
  for (const std::string& scheme : paper::compared_schemes())
    if (scheme != "exponential") figure.panels.push_back(panel_of(atlas, scheme, of_damping));
  figure.height = 1000;
  return figure;
}

std::string times(double percent) {
  const double factor = 1.0 + percent / 100.0;
  if (factor <= 0.0) return fmt::format("a negative damping ratio, {:.3g} times the true one", factor);
  if (factor > 1.5) return fmt::format("{:.3g} times the true damping ratio", factor);
  return fmt::format("a damping ratio {:.3g} % too {}", std::abs(percent), percent > 0 ? "high" : "low");
}

std::string atlas_words(const Atlas& atlas) {
  const Oscillator& beam = atlas.settings.beam;
  std::string text = fmt::format(
      "A mode at {:.5g} Hz with a damping ratio of {:.4g} %, sampled every {:.4g} s ({:.4g} samples per "
      "period).",
      beam.frequency_hz(), 100.0 * beam.damping_ratio(), atlas.settings.interval,
      1.0 / (beam.frequency_hz() * atlas.settings.interval));
  for (const AtlasPoint& p : atlas.own) {
    if (p.scheme == "exponential") continue;
    text += p.predicted ? fmt::format("\n{} would give {}.", p.scheme, times(p.predicted->damping_percent))
                        : fmt::format("\n{} cannot follow it at this step.", p.scheme);
  }
  return text + "\nThe exact discretisation (exponential) has no such error at any step.";
}

Json atlas_values_of(const AtlasPoint& p) {
  Json json{{"discretisation", p.scheme}};
  json["predicted_stiffness_error_percent"] = stiffness_bias(p.predicted);
  json["stiffness_error_percent"] = stiffness_bias(p.measured);
  json["predicted_damping_error_percent"] = damping_bias(p.predicted);
  json["damping_error_percent"] = damping_bias(p.measured);
  return json;
}

}  // namespace

Results report(const Atlas& atlas) {
  Results results;
  results.command = "atlas";
  const Oscillator& beam = atlas.settings.beam;
  results.configuration = {{"frequency_hz", beam.frequency_hz()},
                           {"damping_ratio", beam.damping_ratio()},
                           {"interval_s", atlas.settings.interval},
                           {"damping_ratios", atlas.settings.damping_ratios}};
  results.values["schemes"] = Json::array();
  for (const AtlasPoint& p : atlas.own) results.values["schemes"].push_back(atlas_values_of(p));
  results.heading("What a discretisation does to identified stiffness and damping");
  results.paragraph(atlas_words(atlas));
  results.table(own_table(atlas));
  results.table(harmless_table(atlas, "harmless_rate_1_percent", 1.0));
  results.table(harmless_table(atlas, "harmless_rate_0_1_percent", 0.1));
  results.paragraph(
      "2 stands for any rate that shows the motion at all. A mode at 3.5 Hz that needs 1000 samples per "
      "period needs a sampling rate of 3500 Hz.");
  results.paragraph(
      "A filter that moves its model by a scheme finds the oscillator whose motion the scheme turns into the "
      "record's. Figures: the closed form (lines) and an extended Kalman filter on noise-free displacements "
      "(marks), for five schemes over step and damping ratio; map.csv holds all of it.");
  results.figures = {figure_of(atlas, "damping_error", true), figure_of(atlas, "stiffness_error", false)};
  const std::string map = to_csv(map_table(atlas));
  results.attachments.push_back(
      {{"map.csv"}, [map](const std::filesystem::path& folder) { write_file(folder / "map.csv", map); }});
  return results;
}

}  // namespace beamid::experiments
