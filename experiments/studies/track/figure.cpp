#include "experiments/studies/track/figure.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "experiments/models/estimates.hpp"
#include "experiments/record/axis_label.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double curve_gap = std::numeric_limits<double>::quiet_NaN();

// A horizontal stroke over each plateau, with gaps between them.
template <class Value>
Curve strokes(const Tracking& found, const char* label, Value value) {
  const auto count = static_cast<Index>(found.plateaus.size());
  Curve curve{label, VectorXd(3 * count), VectorXd(3 * count), CurveStyle::line, {}, {}, Colour::vermillion};
  for (Index i = 0; i < count; ++i) {
    const Plateau& plateau = found.plateaus[static_cast<std::size_t>(i)];
    const double y = value(plateau);
    curve.x.segment(3 * i, 3) << plateau.from, plateau.to, plateau.to;
    curve.y.segment(3 * i, 3) << y, y, curve_gap;
  }
  return curve;
}

// Ticks at the alarms, along the lower edge.
Curve ticks(const Tracking& found, double height) {
  const auto count = static_cast<Index>(found.alarms.size());
  Curve curve{"filter re-initialised",
              VectorXd(count),
              VectorXd::Constant(count, height),
              CurveStyle::points,
              {},
              {},
              Colour::black};
  for (Index i = 0; i < count; ++i) curve.x[i] = found.time[found.alarms[static_cast<std::size_t>(i)]];
  return curve;
}

// Without what is hardly known: where the interval of the damping ratio is wider than three times the ratio
// itself.
VectorXd informed(const Tracking& found, const VectorXd& values) {
  constexpr double widest = 3;
  return (2 * quantile_95 * found.damping_ratio_deviation.array() <
          widest * found.damping_ratio.array().abs())
      .select(values.array(), curve_gap);
}

}  // namespace

Figure tracking_figure(const Tracking& found, const Channel& channel) {
  const double begin = found.time[0], end = found.time[found.time.size() - 1];
  Figure figure{"tracking", {}, 3, 1};
  Panel signal = Panel{"", {"time [s]"}, {axis_label(channel.quantity)}}.line("low-passed", found.time,
                                                                              found.signal, Colour::grey);
  signal.legend = Legend::none;

  const auto known = [&](const VectorXd& values) { return informed(found, values); };
  Panel frequency{"", {"time [s]"}, {"frequency [Hz]"}};
  const VectorXd wide = (quantile_95 * found.frequency_deviation).array().exp();
  frequency
      .band("smoothed, 95 %", found.time, found.frequency_hz.cwiseQuotient(wide),
            found.frequency_hz.cwiseProduct(wide), Colour::blue)
      .line("smoothed", found.time, found.frequency_hz, Colour::blue);
  double low = found.band_hz.first, high = found.band_hz.second;
  if (!found.plateaus.empty()) {
    const auto [least, most] = std::minmax_element(
        found.plateaus.begin(), found.plateaus.end(),
        [](const Plateau& a, const Plateau& b) { return a.frequency_hz < b.frequency_hz; });
    low = std::max(low, 0.93 * least->frequency_hz), high = std::min(high, 1.07 * most->frequency_hz);
    frequency.curves.push_back(
        strokes(found, "mean of a plateau", [](const Plateau& p) { return p.frequency_hz; }));
  }
  if (!found.alarms.empty()) frequency.curves.push_back(ticks(found, low + 0.02 * (high - low)));
  frequency.up(low, high).legend = Legend::none;

  Panel damping{"", {"time [s]"}, {"damping ratio [%]"}};
  const VectorXd half = quantile_95 * found.damping_ratio_deviation;
  damping
      .band("smoothed, 95 %", found.time, known(100 * (found.damping_ratio - half)),
            known(100 * (found.damping_ratio + half)), Colour::blue)
      .line("smoothed", found.time, known(100 * found.damping_ratio), Colour::blue);
  double most = 0.2;
  for (const Plateau& p : found.plateaus) most = std::max(most, 250 * p.damping_ratio);
  damping.up(-0.5 * most, most);
  if (!found.plateaus.empty())
    damping.curves.push_back(
        strokes(found, "mean of a plateau", [](const Plateau& p) { return 100 * p.damping_ratio; }));
  if (!found.alarms.empty()) damping.curves.push_back(ticks(found, -0.47 * most));
  figure.panels = {signal, frequency, damping};
  for (Panel& panel : figure.panels) panel.across(begin, end);
  figure.caption =
      "Signal, frequency and damping ratio in time. Where the record holds no information about the damping "
      "ratio its curve is left out.";
  return figure;
}

}  // namespace beamid::experiments
