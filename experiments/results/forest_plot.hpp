// Estimates with intervals, a row each.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/results/figure.hpp"

namespace beamid::experiments {

/// One estimate for each row; NaN where there is none.
struct ForestSeries {
  std::string label;  ///< in the legend; empty where there is one series only
  std::vector<double> value, lower, upper;
  Colour colour = Colour::blue;
  std::vector<PointDetail> details = {};  ///< of a click (figure.hpp): one of all rows, or of each
};

struct ForestReference {
  std::string label;  ///< "true value", "all together"
  double value = 0;
  std::optional<std::pair<double, double>> interval = {};
};

struct ForestPlot {
  std::string title, axis;         ///< "bending stiffness", "error [%]"
  std::vector<std::string> names;  ///< of the rows, from the top
  std::vector<ForestSeries> series;
  std::optional<ForestReference> reference = {};
};

/// Names at the left, estimates with bars as wide as their intervals, the numbers at the right where there is
/// one series. A row far from the others (eight times their scatter or intervals) is an arrow at the frame's
/// edge: it does not flatten the rest, and its number stands at the right.
Panel forest_panel(const ForestPlot& plot);

/// As high as its rows need. [px]
int forest_height(std::size_t rows, std::size_t panels_above_each_other);

}  // namespace beamid::experiments
