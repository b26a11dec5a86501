#include "experiments/studies/atlas/input_hold_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "experiments/identify/model_setting.hpp"
#include "experiments/results/file.hpp"

namespace beamid::experiments {
namespace {

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
      "a step late, and takes the delay for stiffness; one that runs it straight loses a part of it, and "
      "takes that for less damping (with the mass unknown: for less of everything). Steady motion at the "
      "resonance, mass known, exact discretisation.";
  for (const HoldPoint& p : page.own)
    if (p.path == InputPath::held)
      text += fmt::format(" At this step a held force makes K {:+.3g} % and C {:+.3g} % wrong.",
                          p.predicted.stiffness_percent, p.predicted.damping_percent);
  return text;
}

}  // namespace

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

}  // namespace beamid::experiments
