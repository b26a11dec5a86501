#include "experiments/results/gnuplot_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "experiments/results/gnuplot.hpp"

namespace beamid::experiments {
namespace {

using Range = std::pair<double, double>;

// The largest number of the form 1, 2 or 5 times a power of ten that is not above `size`.
double round_step(double size) {
  const double power = std::pow(10.0, std::floor(std::log10(size)));
  return power * (size >= 5 * power ? 5 : size >= 2 * power ? 2 : 1);
}

bool has_points(const Panel& panel) {
  return std::any_of(panel.curves.begin(), panel.curves.end(), [](const Curve& curve) {
    return curve.style == CurveStyle::points || curve.style == CurveStyle::open_points;
  });
}

// A legend's height inside the frame as a part of what the curves take; below zero at the bottom.
double legend_room(const Panel& panel) {
  const auto labels = std::count_if(panel.curves.begin(), panel.curves.end(),
                                    [](const Curve& curve) { return !curve.label.empty(); });
  const double height = std::min(0.06 + 0.09 * static_cast<double>(labels), 0.5);
  switch (panel.legend) {
    case Legend::top_left:
    case Legend::top_right:
      return height / (1 - height);
    case Legend::bottom_left:
    case Legend::bottom_right:
      return -height / (1 - height);
    default:
      return 0;
  }
}

Range logarithmic_range(const Extent& extent, double room) {
  const double decades = std::log10(extent.high / extent.low), margin = std::max(0.06 * decades, 0.02);
  return {extent.low * std::pow(10.0, -margin + std::min(room, 0.0) * decades),
          extent.high * std::pow(10.0, margin + std::max(room, 0.0) * decades)};
}

// A record of 0 to 24.999 s ends at 25, so that its last tick is shown.
Range linear_range(const Extent& extent, bool points) {
  const double span = extent.high - extent.low;
  if (points) return {extent.low - 0.05 * span, extent.high + 0.05 * span};
  const double step = round_step(span / 50), low = std::floor(extent.low / step) * step,
               high = std::ceil(extent.high / step) * step;
  return {extent.low - low <= 0.005 * span ? low : extent.low,
          high - extent.high <= 0.005 * span ? high : extent.high};
}

// Ticks of a logarithmic axis: powers of ten or, where it is too short for those, numbers in between.
std::string logarithmic_ticks(char name, const Range& range) {
  const double decades = std::log10(range.second / range.first);
  if (decades > 2.5)
    return fmt::format("  set format {0} '10^{{%T}}'; set {0}tics autofreq; set m{0}tics 10\n", name);
  using Factors = std::vector<double>;
  const Factors factors = decades > 1.2   ? Factors{1, 2, 5}
                          : decades > 0.5 ? Factors{1, 1.5, 2, 3, 4, 5, 7}
                                          : Factors{1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9};
  std::string ticks;
  const int first = static_cast<int>(std::floor(std::log10(range.first)));
  for (int power = first; power <= first + 3; ++power)
    for (const double factor : factors)
      if (const double tick = factor * std::pow(10.0, power); tick >= range.first && tick <= range.second)
        ticks += fmt::format("{}{:.6g}", ticks.empty() ? "" : ", ", tick);
  return fmt::format("  set format {0} '%g'; set {0}tics ({1})\n", name, ticks);
}

std::string commands(char name, const Axis& axis, const std::optional<Range>& range,
                     const std::string& format) {
  std::string out = fmt::format("  set {}label {}\n", name, gnuplot_text(axis.label));
  out += range ? fmt::format("  set {}range [{}:{}]\n", name, range->first, range->second)
               : fmt::format("  set {}range [*:*]\n", name);
  if (axis.logarithmic)
    return out + fmt::format("  set logscale {}\n", name) + logarithmic_ticks(name, *range);
  return out + fmt::format(
                   "  unset logscale {0}; set format {0} '{1}'; set {0}tics autofreq; set m{0}tics default\n",
                   name, format);
}

}  // namespace

Extent::Extent() : low(std::numeric_limits<double>::infinity()), high(-low) {}

void Extent::add(const Eigen::VectorXd& values, bool positive) {
  for (const double value : values) {
    if (!std::isfinite(value) || (positive && value <= 0)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
}

std::string axis_commands(const Panel& panel) {
  Extent across, up;
  for (const Curve& curve : panel.curves) {
    across.add(curve.x, panel.x_axis.logarithmic);
    for (const auto* values : {&curve.y, &curve.lower, &curve.upper})
      up.add(*values, panel.y_axis.logarithmic);
  }
  const double room = legend_room(panel);

  std::optional<Range> x_range = panel.x_axis.range, y_range = panel.y_axis.range;
  if (!x_range && across.empty()) x_range = {panel.x_axis.logarithmic ? 0.1 : 0.0, 1.0};
  if (!x_range && panel.x_axis.logarithmic) x_range = logarithmic_range(across, 0);
  if (!x_range && across.low < across.high) x_range = linear_range(across, has_points(panel));
  // A linear vertical axis is left to gnuplot, which ends it on ticks.
  std::string offsets = "0, 0, 0, 0";
  if (!y_range && up.empty()) y_range = {panel.y_axis.logarithmic ? 0.1 : 0.0, 1.0};
  if (!y_range && panel.y_axis.logarithmic) y_range = logarithmic_range(up, room);
  if (!y_range)
    offsets = fmt::format("0, 0, graph {:.2f}, graph {:.2f}", std::max(room, 0.0), std::max(-room, 0.0));
  // Labels at least four characters wide give panels below each other the same left margin.
  return commands('x', panel.x_axis, x_range, "%h") + commands('y', panel.y_axis, y_range, "%4h") +
         fmt::format("  set offsets {}\n", offsets);
}

}  // namespace beamid::experiments
