// The bias of every discretisation, over steps and damping ratios, and for a user's own beam.
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/verdict/plausibility.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/results/results.hpp"
#include "experiments/studies/atlas/atlas.hpp"
#include "experiments/studies/atlas/many_degrees.hpp"
#include "experiments/studies/paper/numerical_validation.hpp"
#include "experiments/studies/study.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {
namespace {

// The atlas as a report.

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

// The page of inputs between samples in the atlas.

using Eigen::Index, Eigen::VectorXd;

Table hold_table(const char* name, const char* title, const std::vector<HoldPoint>& points) {
  Table table{name, title};
  table.column({"input", "input"})
      .column({"samples per period", "samples_per_period", "{:.4g}"})
      .column({"K, closed form [%]", "predicted_stiffness_error_percent", "{:+.5g}"})
      .column({"K, EKF [%]", "stiffness_error_percent", "{:+.5g}"})
      .column({"C, closed form [%]", "predicted_damping_error_percent", "{:+.5g}"})
      .column({"C, EKF [%]", "damping_error_percent", "{:+.5g}"});
  const double none = std::nan("");
  for (const HoldPoint& p : points)
    table.row({to_string(p.path), p.samples_per_period, p.predicted.stiffness_percent,
               p.measured ? p.measured->stiffness_percent : none, p.predicted.damping_percent,
               p.measured ? p.measured->damping_percent : none});
  return table;
}

// |error| over samples per period: lines in closed form, marks of the filter.
Panel hold_panel(const HoldPage& page, double Bias::*of, const char* label) {
  constexpr double smallest = 1e-7;  // [%], below which is rounding
  Panel panel{"", {"samples per period", true}, {label, true, std::pair{smallest, 100.0}}};
  const std::pair<InputPath, Colour> shown[] = {{InputPath::held, Colour::vermillion},
                                                {InputPath::linear, Colour::blue},
                                                {InputPath::band_limited, Colour::green}};
  for (const auto& [path, colour] : shown) {
    std::vector<double> x, y, at, measured;
    for (const HoldPoint& p : page.map) {
      if (p.path != path) continue;
      x.push_back(p.samples_per_period);
      y.push_back(std::abs(p.predicted.*of) > smallest ? std::abs(p.predicted.*of) : std::nan(""));
      if (p.measured && std::abs((*p.measured).*of) > smallest)
        at.push_back(p.samples_per_period), measured.push_back(std::abs((*p.measured).*of));
    }
    const auto vector = [](const std::vector<double>& v) {
      return VectorXd(Eigen::Map<const VectorXd>(v.data(), static_cast<Index>(v.size())));
    };
    const bool exact = path == InputPath::band_limited;  // no line to draw
    if (!exact) panel.line(to_string(path), vector(x), vector(y), colour);
    panel.open_points(exact ? to_string(path) : "", vector(at), vector(measured), colour);
  }
  return panel;
}

std::string hold_text(const HoldPage& page) {
  std::string text =
      "A measured force is known at samples only. A filter that holds it until the next one applies it half "
      "a step late, and takes the delay for stiffness. One that runs it straight loses a part of it, and "
      "takes that for less damping (with the mass unknown: for less of everything). Steady motion at the "
      "resonance, mass known, exact discretisation.";
  for (const HoldPoint& p : page.own)
    if (p.path == InputPath::held)
      text += fmt::format(" At this step a held force makes K {:+.3g} % and C {:+.3g} % wrong.",
                          p.predicted.stiffness_percent, p.predicted.damping_percent);
  return text;
}

/// Adds it: text, table `input_hold`, figure `input_hold_error`, input_hold_map.csv, key `input_hold` of
/// results.json.
void add_hold_page(const HoldPage& page, const Oscillator& mode, Results& results) {
  results.heading("Inputs between samples");
  results.paragraph(hold_text(page));
  results.table(hold_table("input_hold", "Of a measured force, at this step", page.own));
  results.values["input_hold"] = nlohmann::ordered_json::array();
  for (const HoldPoint& p : page.own) {
    nlohmann::ordered_json one{{"input", to_string(p.path)},
                               {"samples_per_period", p.samples_per_period},
                               {"predicted_stiffness_error_percent", p.predicted.stiffness_percent},
                               {"predicted_damping_error_percent", p.predicted.damping_percent}};
    one["stiffness_error_percent"] =
        p.measured ? nlohmann::ordered_json(p.measured->stiffness_percent) : nullptr;
    one["damping_error_percent"] = p.measured ? nlohmann::ordered_json(p.measured->damping_percent) : nullptr;
    results.values["input_hold"].push_back(std::move(one));
  }
  Figure figure{"input_hold_error",
                {hold_panel(page, &Bias::stiffness_percent, "|error of K| [%]"),
                 hold_panel(page, &Bias::damping_percent, "|error of C| [%]")},
                1,
                2};
  figure.width = 1000;
  figure.caption = fmt::format(
      "Identified from a measured force at the resonance, damping ratio {:.4g} %: closed form (lines) and an "
      "extended Kalman filter (marks), by how the force is taken between its samples.",
      100.0 * mode.damping_ratio());
  results.figures.push_back(std::move(figure));
  const std::string map = to_csv(hold_table("input_hold_map", "", page.map));
  results.attachments.push_back({{"input_hold_map.csv"}, [map](const std::filesystem::path& folder) {
                                   write_file(folder / "input_hold_map.csv", map);
                                 }});
}

/// The first mode of the beam that an experiment file describes; its sampling rate, when it states one.
AtlasSettings described(const std::string& file, AtlasSettings settings) {
  const Experiment experiment = read_experiment(file);
  require_linear_storeys(experiment, "atlas");
  const fem::Modes modes = fem::modes(fem::assemble(experiment.structure, experiment.elements), 1);
  double ratio = settings.beam.damping_ratio();
  if (!std::holds_alternative<fem::Undamped>(experiment.damping))
    ratio = fem::damping_ratios(experiment.damping, modes.angular_frequency)[0];
  settings.beam = Oscillator::from_frequency(1.0, modes.angular_frequency[0], ratio);
  if (experiment.format.sampling_rate) settings.interval = 1.0 / *experiment.format.sampling_rate;
  return settings;
}

class AtlasStudy final : public Study {
 public:
  explicit AtlasStudy(const filters::Options& options) {
    const double frequency = options.number("frequency"), ratio = options.number("damping_ratio");
    if (!(frequency > 0.0)) throw std::invalid_argument("frequency must be above 0 Hz");
    if (!(ratio > 0.0 && ratio < 1.0)) throw std::invalid_argument("damping_ratio must be between 0 and 1");
    settings_.beam = Oscillator::from_frequency(1.0, 2.0 * std::numbers::pi * frequency, ratio);
    settings_.interval = options.number("interval");
    config_ = options.text("config");
    if (!config_.empty()) settings_ = described(config_, settings_);
  }

  Results run(const Progress& progress) const override {
    Results results = report(make_atlas(settings_, progress));
    add_hold_page(make_hold_page(settings_, progress), settings_.beam, results);
    add_degrees_page(make_degrees_page(progress), results);
    warn_of_file(results, config_);
    return results;
  }

 private:
  AtlasSettings settings_;
  std::string config_;
};

const bool atlas_registered = study_registry().add(
    {"atlas",
     "the bias of stiffness and damping by every discretisation: closed form and filter",
     "[hairer1996]",
     {{"frequency", 3.4555, "Hz", "of the mode in question; by default that of the beam S(11.8)"},
      {"damping_ratio", 0.0045, "", "of it"},
      {"interval", 0.004, "s", "between samples"},
      {"config", std::string(), "",
       "experiment file whose beam's first mode, damping and sampling rate to take"}},
     {},
     [](const filters::Options& options) { return std::make_unique<AtlasStudy>(options); }});

}  // namespace

}  // namespace beamid::experiments
