// Curves added to a panel.
#include <algorithm>
#include <utility>

#include "experiments/results/figure.hpp"
#include "experiments/results/gnuplot_axes.hpp"

namespace beamid::experiments {
namespace {

/// Where a straight line across the panel begins and ends.
Eigen::VectorXd panel_ends(const Axis& axis, const std::vector<Curve>& curves, bool upright) {
  Extent extent;
  for (const Curve& curve : curves)
    for (const auto* values : {upright ? &curve.y : &curve.x, upright ? &curve.lower : &curve.x,
                               upright ? &curve.upper : &curve.x})
      extent.add(*values, axis.logarithmic);
  if (extent.empty()) extent.low = extent.high = 1.0;
  const auto [low, high] = axis.range.value_or(std::pair{extent.low, extent.high});
  return Eigen::Vector2d(low, high);
}

}  // namespace

Panel& Panel::add(CurveStyle style, std::string label, Values x, Values y, Colour colour) {
  curves.push_back({std::move(label), std::move(x), std::move(y), style, {}, {}, colour});
  return *this;
}

Panel& Panel::line(std::string label, Values x, Values y, Colour colour) {
  return add(CurveStyle::line, std::move(label), std::move(x), std::move(y), colour);
}

Panel& Panel::thin(std::string label, Values x, Values y, Colour colour) {
  return add(CurveStyle::thin, std::move(label), std::move(x), std::move(y), colour);
}

Panel& Panel::dashed(std::string label, Values x, Values y, Colour colour) {
  return add(CurveStyle::dashed, std::move(label), std::move(x), std::move(y), colour);
}

Panel& Panel::points(std::string label, Values x, Values y, Colour colour) {
  return add(CurveStyle::points, std::move(label), std::move(x), std::move(y), colour);
}

Panel& Panel::open_points(std::string label, Values x, Values y, Colour colour) {
  return add(CurveStyle::open_points, std::move(label), std::move(x), std::move(y), colour);
}

Panel& Panel::band(std::string label, Values x, Values lower, Values upper, Colour colour) {
  add(CurveStyle::band, std::move(label), std::move(x), {}, colour);
  curves.back().lower = std::move(lower);
  curves.back().upper = std::move(upper);
  return *this;
}

Panel& Panel::bars(std::string label, Values x, Values y, Values lower, Values upper, Colour colour) {
  points(std::move(label), std::move(x), std::move(y), colour);
  curves.back().lower = std::move(lower);
  curves.back().upper = std::move(upper);
  return *this;
}

Panel& Panel::level(std::string label, double height, Colour colour) {
  return dashed(std::move(label), panel_ends(x_axis, curves, false), Eigen::Vector2d::Constant(height),
                colour);
}

Panel& Panel::upright(std::string label, double place, Colour colour) {
  return dashed(std::move(label), Eigen::Vector2d::Constant(place), panel_ends(y_axis, curves, true), colour);
}

Panel& Panel::across(double from, double to) {
  x_axis.range = {from, to};
  return *this;
}

Panel& Panel::up(double from, double to) {
  y_axis.range = {from, to};
  return *this;
}

Panel& Panel::key(Legend place) {
  legend = place;
  return *this;
}

}  // namespace beamid::experiments
