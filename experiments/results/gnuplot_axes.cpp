#include "experiments/results/gnuplot_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "experiments/results/gnuplot.hpp"
#include "experiments/results/gnuplot_curves.hpp"
#include "experiments/results/gnuplot_ticks.hpp"
#include "experiments/results/typeset.hpp"

namespace beamid::experiments {
namespace {

bool has_points(const Panel& panel) {
  return std::any_of(panel.curves.begin(), panel.curves.end(), [](const Curve& curve) {
    return curve.style == CurveStyle::points || curve.style == CurveStyle::open_points ||
           curve.style == CurveStyle::intervals;
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

AxisRange logarithmic_range(const Extent& extent, double room) {
  const double decades = std::log10(extent.high / extent.low), margin = std::max(0.06 * decades, 0.02);
  return {extent.low * std::pow(10.0, -margin + std::min(room, 0.0) * decades),
          extent.high * std::pow(10.0, margin + std::max(room, 0.0) * decades)};
}

// A record of 0 to 24.999 s ends at 25, so that its last tick is shown.
AxisRange linear_range(const Extent& extent, bool points) {
  const double span = extent.high - extent.low;
  if (points) return {extent.low - 0.05 * span, extent.high + 0.05 * span};
  const double step = rounded_up_step(span / 100), low = std::floor(extent.low / step) * step,
               high = std::ceil(extent.high / step) * step;
  return {extent.low - low <= 0.005 * span ? low : extent.low,
          high - extent.high <= 0.005 * span ? high : extent.high};
}

// A vertical axis ends on ticks.
AxisRange upright_range(const Extent& extent, bool points, double room, double length) {
  double span = extent.high - extent.low;
  if (!(span > 1e-12 * std::max(std::abs(extent.low), std::abs(extent.high))))
    span = extent.high != 0 ? 0.2 * std::abs(extent.high) : 2;
  double low = extent.low, high = extent.high;
  if (span > extent.high - extent.low) low -= 0.5 * span, high += 0.5 * span;
  if (points) low -= 0.03 * span, high += 0.03 * span;
  high += std::max(room, 0.0) * span, low += std::min(room, 0.0) * span;
  const double step = step_for({low, high}, length, true);
  return {std::floor(low / step + 1e-9) * step, std::ceil(high / step - 1e-9) * step};
}

DrawnAxis drawn_axis(char name, const Axis& axis, const AxisRange& range, double length) {
  const bool named = !axis.names.empty();
  const Ticks ticks =
      named ? named_ticks(std::string(1, name), axis.names)
      : axis.logarithmic
          ? logarithmic_ticks(name, range, length)
          : linear_ticks(name, range, axis.tick > 0 ? axis.tick : step_for(range, length, name == 'y'));
  return {fmt::format("  set {0}label {1}\n  set {0}range [{2}:{3}]\n{4}", name,
                      gnuplot_text(typeset(axis.label)), range.first, range.second,
                      axis.logarithmic && !named ? fmt::format("  set logscale {}\n", name) : "") +
              ticks.commands,
          ticks.widest, range};
}

AxisRange named_range(const Axis& axis, bool upright) {
  const double first = 0.4, last = static_cast<double>(axis.names.size()) + 0.6;
  return upright ? AxisRange{last, first} : AxisRange{first, last};
}

AxisRange empty_range(const Axis& axis) {
  return {axis.logarithmic ? 0.1 : 0.0, 1.0};
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

DrawnAxis drawn_x_axis(const Panel& panel, double length) {
  const Axis& axis = panel.x_axis;
  if (!axis.names.empty()) return drawn_axis('x', axis, named_range(axis, false), length);
  Extent extent;
  for (const Curve& curve : panel.curves) {
    extent.add(curve.x, axis.logarithmic);
    if (along_x(curve)) extent.add(curve.lower, axis.logarithmic), extent.add(curve.upper, axis.logarithmic);
  }
  std::optional<AxisRange> range = axis.range;
  if (!range && extent.empty()) range = empty_range(axis);
  if (!range && axis.logarithmic) range = logarithmic_range(extent, 0);
  if (!range && extent.low < extent.high) range = linear_range(extent, has_points(panel));
  if (!range) range = upright_range(extent, true, 0, length);
  return drawn_axis('x', axis, *range, length);
}

DrawnAxis drawn_y_axis(const Panel& panel, double length) {
  const Axis& axis = panel.y_axis;
  if (!axis.names.empty()) return drawn_axis('y', axis, named_range(axis, true), length);
  Extent extent;
  for (const Curve& curve : panel.curves) {
    extent.add(curve.y, axis.logarithmic);
    if (curve.style == CurveStyle::stems) extent.add(Eigen::VectorXd::Zero(1), axis.logarithmic);
    if (!along_x(curve)) extent.add(curve.lower, axis.logarithmic), extent.add(curve.upper, axis.logarithmic);
  }
  std::optional<AxisRange> range = axis.range;
  if (!range && extent.empty()) range = empty_range(axis);
  if (!range && axis.logarithmic) range = logarithmic_range(extent, legend_room(panel));
  if (!range) range = upright_range(extent, has_points(panel), legend_room(panel), length);
  return drawn_axis('y', axis, *range, length);
}

}  // namespace beamid::experiments
