#include "experiments/results/thinned_panel.hpp"

#include <algorithm>
#include <vector>

#include "experiments/results/envelope.hpp"
#include "experiments/results/gnuplot_axes.hpp"

namespace beamid::experiments {
namespace {

constexpr Eigen::Index long_curve = 20000;  // points

void keep_points(Curve& curve, const std::vector<Eigen::Index>& kept) {
  for (Eigen::VectorXd* values : {&curve.x, &curve.y, &curve.lower, &curve.upper})
    if (values->size() > 0) *values = (*values)(kept).eval();
}

Curve thinned(const Curve& curve, const Axis& x_axis) {
  const bool ascending = curve.x.allFinite() && std::is_sorted(curve.x.begin(), curve.x.end());
  Curve part = x_axis.range && ascending ? visible_part(curve, *x_axis.range) : curve;
  if (is_line(part))
    keep_points(part,
                envelope(part.x, part.style == CurveStyle::band ? part.upper : part.y, x_axis.logarithmic));
  return part;
}

Extent height(const Curve& curve, bool positive) {
  Extent extent;
  for (const Eigen::VectorXd* values : {&curve.y, &curve.lower, &curve.upper}) extent.add(*values, positive);
  return extent;
}

bool is_as_high(const Curve& part, const Curve& whole, const Axis& y_axis) {
  const Extent of_part = height(part, y_axis.logarithmic), of_whole = height(whole, y_axis.logarithmic);
  if (y_axis.range) return of_part.empty() == of_whole.empty();
  return of_part.low == of_whole.low && of_part.high == of_whole.high;
}

}  // namespace

bool is_line(const Curve& curve) {
  const CurveStyle style = curve.style;
  return style == CurveStyle::line || style == CurveStyle::dashed || style == CurveStyle::dotted ||
         style == CurveStyle::thin || style == CurveStyle::band;
}

Curve visible_part(const Curve& curve, const std::pair<double, double>& range) {
  const auto first = std::lower_bound(curve.x.begin(), curve.x.end(), range.first);
  const auto last = std::upper_bound(curve.x.begin(), curve.x.end(), range.second);
  const Eigen::Index begin = std::max<Eigen::Index>(first - curve.x.begin() - 1, 0),
                     end = std::min<Eigen::Index>(last - curve.x.begin() + 1, curve.x.size());
  const auto cut = [&](const Eigen::VectorXd& values) {
    return values.size() > 0 ? values.segment(begin, end - begin).eval() : Eigen::VectorXd();
  };
  return {curve.label,      cut(curve.x),     cut(curve.y), curve.style,
          cut(curve.lower), cut(curve.upper), curve.colour};
}

Panel thinned(Panel panel) {
  if (!panel.x_axis.range) return panel;
  for (Curve& curve : panel.curves) {
    if (curve.x.size() < long_curve || !is_line(curve)) continue;
    Curve part = thinned(curve, panel.x_axis);
    if (is_as_high(part, curve, panel.y_axis)) curve = std::move(part);
  }
  return panel;
}

}  // namespace beamid::experiments
