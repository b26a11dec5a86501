#include <algorithm>
#include <cmath>

#include "experiments/studies/posterior/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr std::size_t most_in_corner = 4;
constexpr Index most_points = 600, density_bars = 60;

VectorXd thinned(const Eigen::MatrixXd& draws) {
  const Index stride = std::max<Index>(1, draws.size() / most_points), count = draws.size() / stride;
  VectorXd points(count);
  for (Index i = 0; i < count; ++i) points[i] = draws.data()[i * stride];
  return points;
}

// Share of the draws over the width of each of equal bars, as an outline.
std::pair<VectorXd, VectorXd> density_of(const Eigen::MatrixXd& draws) {
  const double low = draws.minCoeff(), high = draws.maxCoeff(), width = (high - low) / density_bars;
  VectorXd x(2 * density_bars), y = VectorXd::Zero(2 * density_bars);
  for (Index i = 0; i < density_bars; ++i) {
    x[2 * i] = low + width * static_cast<double>(i);
    x[2 * i + 1] = low + width * static_cast<double>(i + 1);
  }
  for (Index i = 0; i < draws.size(); ++i) {
    const Index bar = std::min<Index>(density_bars - 1, static_cast<Index>((draws.data()[i] - low) / width));
    y[2 * bar] += 1.0 / (width * static_cast<double>(draws.size()));
    y[2 * bar + 1] = y[2 * bar];
  }
  return {x, y};
}

}  // namespace

Figure corner_figure(const PosteriorStudy& study) {
  const std::size_t count = std::min(study.unknowns().size(), most_in_corner);
  std::vector<Eigen::MatrixXd> draws;
  std::vector<std::string> labels;
  for (std::size_t j = 0; j < count; ++j) {
    const Unknown& unknown = study.unknowns()[j];
    draws.push_back(study.draws(j));
    labels.push_back(unknown.unit.empty() ? unknown.name : unknown.name + " [" + unknown.unit + "]");
  }
  Figure figure{"corner", {}};
  for (std::size_t row = 0; row < count; ++row)
    for (std::size_t column = 0; column < count; ++column) {
      Panel panel{"", {labels[column]}, {row == column ? "density" : labels[row]}};
      panel.x_axis.range = {draws[column].minCoeff(), draws[column].maxCoeff()};
      panel.key(Legend::none);
      if (row == column) {
        const auto [x, y] = density_of(draws[row]);
        panel.line("", x, y, Colour::blue);
      } else {
        panel.points("", thinned(draws[column]), thinned(draws[row]), Colour::blue);
      }
      figure.panels.push_back(std::move(panel));
    }
  figure.rows = figure.columns = static_cast<int>(count);
  figure.width = std::max(500, 330 * figure.columns);
  figure.caption = "Draws of the posterior, each parameter against each other; densities on the diagonal.";
  return figure;
}

}  // namespace beamid::experiments
