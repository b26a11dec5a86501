// What an axis shows and where its ticks are, in gnuplot's language.
#pragma once

#include <string>

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

/// Labels, ranges and ticks of both axes, with room for a legend inside the frame.
std::string axis_commands(const Panel& panel);

}  // namespace beamid::experiments
