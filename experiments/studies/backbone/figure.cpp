#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/models/estimates.hpp"
#include "experiments/studies/backbone/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;
using std::numbers::pi;

template <typename Value>
VectorXd by_window(const BackboneStudy& study, const Value& value) {
  const auto& windows = study.windows.windows;
  VectorXd values(static_cast<Index>(windows.size()));
  for (Index i = 0; i < values.size(); ++i) values[i] = value(windows[static_cast<std::size_t>(i)]);
  return values;
}

}  // namespace

Figure backbone_figure(const BackboneStudy& study, double mass) {
  const VectorXd a = by_window(study, [](const auto&w) { return w.amplitude; }),
                 k = by_window(study, [](const auto&w) { return w.stiffness; }),
                 kd = by_window(study, [](const auto&w) { return quantile_95 * w.stiffness_deviation; }),
                 c = by_window(study, [](const auto&w) { return w.damping; }),
                 cd = by_window(study, [](const auto&w) { return quantile_95 * w.damping_deviation; });
  Panel stiffness{"stiffness of the windows", {"amplitude [mm]", true}, {"K(A) [N/m]"}};
  stiffness.bars("joint filter, 95 %", 1e3 * a, k, k - kd, k + kd, Colour::black);
  Panel damping{"damping of the windows", {"amplitude [mm]", true}, {"C(A) [N s/m]"}};
  damping.bars("joint filter, 95 %", 1e3 * a, c, c - cd, c + cd, Colour::black);
  constexpr Index points = 80;
  const double low = study.smallest(), high = study.largest(), k0 = study.first_stiffness();
  VectorXd x(points), force(points), half(points), naive(points), secant(points), energy(points);
  for (Index i = 0; i < points; ++i) {
    x[i] = low * std::pow(high / low, static_cast<double>(i) / (points - 1));
    secant[i] = study.backbone.secant(x[i]);
    force[i] = study.backbone.force(x[i]);
    half[i] = quantile_95 * x[i] * study.backbone.secant_deviation(x[i]);
    naive[i] = x[i] <= study.windows.first_amplitude ? x[i] * study.secants.secant(x[i]) : std::nan("");
    const double omega = std::sqrt(std::max(study.secants.secant(x[i]), 0.1 * secant[i]) / mass);
    energy[i] = study.energy(x[i], omega) / (2 * pi * x[i] * force[i]);
  }
  stiffness.line("F/x of the backbone", 1e3 * x, secant, Colour::blue);
  Panel backbone{"backbone", {"displacement [mm]"}, {"force [N]"}};
  backbone.band("95 %", 1e3 * x, force - half, force + half, Colour::blue)
      .line("backbone", 1e3 * x, force, Colour::blue)
      .dashed("secants K(A) A", 1e3 * x, naive, Colour::vermillion);
  Panel normalised{
      "stiffness over its value at " + std::string(study.law() ? "rest" : "the smallest amplitude"),
      {"amplitude [mm]", true},
      {"G/Gmax"}};
  normalised.line("backbone", 1e3 * x, secant / k0, Colour::blue);
  Panel ratios{"energy of a cycle over 2 pi F(A) A", {"amplitude [mm]", true}, {"D [%]"}};
  if (study.law()) ratios.line("law", 1e3 * x, 100 * energy, Colour::blue);
  VectorXd ratio(a.size()), half_ratio(a.size());
  for (Index i = 0; i < a.size(); ++i) {
    const AmplitudeWindow& window = study.windows.windows[static_cast<std::size_t>(i)];
    const double omega = 2 * pi * window.frequency_hz;
    ratio[i] = 100 * window.fall / omega;
    half_ratio[i] = 100 * cd[i] / (2 * mass * omega);
  }
  ratios.bars("windows, 95 %", 1e3 * a, ratio, ratio - half_ratio, ratio + half_ratio, Colour::black);
  Figure figure{"force_law", {stiffness, damping, backbone, normalised, ratios}, 3, 2};
  figure.width = 1100;
  figure.height = 1250;
  figure.caption =
      "Stiffness and damping of the windows by amplitude, the backbone with its 95 % band beside the "
      "secants, and what soil dynamics calls G/Gmax and D.";
  return figure;
}

}  // namespace beamid::experiments
