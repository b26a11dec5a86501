// What an axis shows and where its ticks are, in gnuplot's language.
#pragma once

#include <string>
#include <utility>

#include "experiments/results/figure.hpp"

namespace beamid::experiments {

/// The smallest and the largest of some values.
struct Extent {
  double low, high;

  Extent();

  /// Takes the finite values in; of those only the positive ones, if so wished.
  void add(const Eigen::VectorXd& values, bool positive);
  bool empty() const { return !(low <= high); }
};

/// Label, range and ticks of an axis.
struct DrawnAxis {
  std::string commands;
  double widest = 0;                         ///< [px] of its ticks' labels, in the SVG
  std::pair<double, double> range = {0, 1};  ///< from left to right, from below upwards
};

/// @param length [px] of the frame along the axis, in the SVG: as many ticks as have room there.
DrawnAxis drawn_x_axis(const Panel& panel, double length);

/// With room for a legend inside the frame. @param length as above
DrawnAxis drawn_y_axis(const Panel& panel, double length);

}  // namespace beamid::experiments
