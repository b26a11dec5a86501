#include <algorithm>
#include <cmath>

#include "experiments/models/estimates.hpp"
#include "experiments/studies/identify/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr std::size_t most_panels = 6;

Panel autocorrelation(const filters::Diagnostics& found, std::size_t i, const std::string& output) {
  const VectorXd& correlation = found.whiteness[i].autocorrelation;
  const Index lags = correlation.size();
  const double counted = found.histogram.counts.row(static_cast<Index>(i)).sum();
  const double bound = quantile_95 / std::sqrt(std::max(counted, 1.0));
  const double last = static_cast<double>(lags) + 1.0;
  return Panel{output, {"lag [samples]"}, {"autocorrelation"}}
      .across(0.0, last)
      .band("95 % of white noise", Eigen::Vector2d(0.0, last), Eigen::Vector2d::Constant(-bound),
            Eigen::Vector2d::Constant(bound), Colour::grey)
      .line("", Eigen::Vector2d(0.0, last), Eigen::Vector2d::Zero(), Colour::grey)
      .add(CurveStyle::stems, "innovations", VectorXd::LinSpaced(lags, 1.0, last - 1.0), correlation,
           Colour::blue);
}

// A bar's outline: its value from edge to edge.
Curve outline(const VectorXd& edges, const VectorXd& counts) {
  const Index bins = counts.size();
  Curve curve{"innovations", VectorXd(2 * bins), VectorXd(2 * bins)};
  for (Index b = 0; b < bins; ++b) {
    curve.x.segment<2>(2 * b) = edges.segment<2>(b);
    curve.y.segment<2>(2 * b).setConstant(counts[b]);
  }
  curve.colour = Colour::blue;
  return curve;
}

Panel histogram(const filters::Diagnostics& found, std::size_t i, const std::string& output) {
  const auto& h = found.histogram;
  const auto row = static_cast<Index>(i);
  const VectorXd middles = 0.5 * (h.edges.head(h.counts.cols()) + h.edges.tail(h.counts.cols()));
  Panel panel{output, {"innovation / its standard deviation"}, {"samples"}};
  panel.curves.push_back(outline(h.edges, h.counts.row(row).transpose()));
  return panel.dashed("expected", middles, h.expected.row(row).transpose(), Colour::black);
}

}  // namespace

std::vector<Figure> figures(const filters::Diagnostics& found, const std::vector<std::string>& outputs) {
  const std::size_t panels = std::min(most_panels, outputs.size());
  const int columns = panels > 1 ? 2 : 1, rows = (static_cast<int>(panels) + columns - 1) / columns;
  Figure correlations{"innovation_autocorrelation", {}, rows, columns},
      histograms{"innovation_histogram", {}, rows, columns};
  for (std::size_t i = 0; i < panels; ++i) {
    correlations.panels.push_back(autocorrelation(found, i, outputs[i]));
    histograms.panels.push_back(histogram(found, i, outputs[i]));
  }
  correlations.caption =
      "Autocorrelation of the innovations: of a filter whose model and noise are right, that of white noise.";
  histograms.caption = "Innovations over their own standard deviation, and what is expected of normal ones.";
  return {correlations, histograms};
}

}  // namespace beamid::experiments
