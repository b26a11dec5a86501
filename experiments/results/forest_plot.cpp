#include "experiments/results/forest_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/results/gnuplot_axes.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double forest_far = 8;  // times scatter or interval

VectorXd forest_values(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
}

double quantile_of(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  const double place = part * static_cast<double>(values.size() - 1);
  const auto i = static_cast<std::size_t>(place);
  const double next = values[std::min(i + 1, values.size() - 1)];
  return values[i] + (place - static_cast<double>(i)) * (next - values[i]);
}

/// What the axis shows: the rows near each other, their intervals as far as they are not far, the reference.
Extent shown_part(const ForestPlot& plot) {
  std::vector<double> values, widths;
  for (const ForestSeries& series : plot.series)
    for (std::size_t i = 0; i < series.value.size(); ++i)
      if (std::isfinite(series.value[i])) {
        values.push_back(series.value[i]);
        if (const double width = series.upper[i] - series.lower[i]; std::isfinite(width))
          widths.push_back(width);
      }
  Extent extent;
  const auto take = [&](double value) { extent.add(VectorXd::Constant(1, value), false); };
  if (plot.reference) {
    take(plot.reference->value);
    if (plot.reference->interval)
      take(plot.reference->interval->first), take(plot.reference->interval->second);
  }
  if (values.empty()) return extent;
  const double middle = quantile_of(values, 0.5);
  const double scatter = std::max(quantile_of(values, 0.75) - quantile_of(values, 0.25),
                                  widths.empty() ? 0.0 : quantile_of(widths, 0.5));
  const bool all = !(scatter > 0);
  const double low = middle - forest_far * scatter, high = middle + forest_far * scatter;
  for (const ForestSeries& series : plot.series)
    for (std::size_t i = 0; i < series.value.size(); ++i) {
      if (!all && !(series.value[i] >= low && series.value[i] <= high)) continue;
      take(series.value[i]);
      for (const double bound : {series.lower[i], series.upper[i]})
        if (std::isfinite(bound)) take(all ? bound : std::clamp(bound, low, high));
    }
  return extent;
}

/// "0.0021 (-0.0100 to 0.0142)", two digits of the interval.
std::string forest_text(double value, double lower, double upper) {
  if (!std::isfinite(value)) return "-";
  const double half = 0.5 * (upper - lower);
  const double large = std::max(std::abs(value), half);
  if (!(half > 0) || !std::isfinite(half) || large >= 1e6 || half < 1e-7) return fmt::format("{:.4g}", value);
  const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(half))), 0, 9);
  return fmt::format("{0:.{3}f} ({1:.{3}f} to {2:.{3}f})", value, lower, upper, decimals);
}

}  // namespace

Panel forest_panel(const ForestPlot& plot) {
  Extent extent = shown_part(plot);
  if (extent.empty()) extent.low = 0, extent.high = 1;
  if (!(extent.high > extent.low)) {
    const double half = std::max(1e-3 * std::abs(extent.low), 1e-12);
    extent.low -= half, extent.high += half;
  }
  const double span = extent.high - extent.low, low = extent.low - 0.06 * span,
               high = extent.high + 0.06 * span;
  Panel panel{plot.title, {plot.axis, false, std::pair{low, high}}, {""}};
  panel.y_axis.names = plot.names;
  const auto rows = static_cast<double>(plot.names.size());
  if (plot.reference) {
    const Eigen::Vector2d ends(0.4, rows + 0.6);
    if (const auto& interval = plot.reference->interval) {
      const Eigen::Vector4d x(interval->first, interval->second, interval->second, interval->first);
      panel.band(plot.reference->label + ", 95 %", Eigen::Vector2d(interval->first, interval->second),
                 Eigen::Vector2d::Constant(ends[0]), Eigen::Vector2d::Constant(ends[1]), Colour::grey);
    }
    panel.dashed(plot.reference->label, Eigen::Vector2d::Constant(plot.reference->value), ends,
                 Colour::black);
  }
  const auto count = plot.series.size();
  for (std::size_t k = 0; k < count; ++k) {
    const ForestSeries& series = plot.series[k];
    const double shift =
        count > 1 ? 0.5 * ((static_cast<double>(k) + 0.5) / static_cast<double>(count) - 0.5) : 0.0;
    VectorXd place = VectorXd::LinSpaced(static_cast<Index>(series.value.size()), 1, rows).array() + shift;
    if (series.value.size() == 1) place[0] = 1 + shift;
    VectorXd value = forest_values(series.value), lower = forest_values(series.lower),
             upper = forest_values(series.upper);
    std::vector<double> at, from, to;
    for (Index i = 0; i < value.size(); ++i)
      if (value[i] < low || value[i] > high) {
        const bool left = value[i] < low;
        at.push_back(place[i]);
        from.push_back(left ? low + 0.05 * span : high - 0.05 * span);
        to.push_back(left ? low : high);
      }
    panel.add(CurveStyle::intervals, series.label, value, place, series.colour);
    panel.curves.back().lower = lower;
    panel.curves.back().upper = upper;
    panel.curves.back().details = series.details;
    if (at.empty()) continue;
    panel.add(CurveStyle::arrows, "", forest_values(to), forest_values(at), series.colour);
    panel.curves.back().lower = forest_values(from);
    panel.curves.back().upper = forest_values(to);
    if (series.details.size() == 1) panel.curves.back().details = series.details;
  }
  if (count == 1)
    for (std::size_t i = 0; i < plot.names.size(); ++i)
      panel.remarks.push_back(
          forest_text(plot.series[0].value[i], plot.series[0].lower[i], plot.series[0].upper[i]));
  return panel;
}

int forest_height(std::size_t rows, std::size_t panels_above_each_other) {
  return static_cast<int>((110 + 26 * rows) * panels_above_each_other + 40);
}

}  // namespace beamid::experiments
