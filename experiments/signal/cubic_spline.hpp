// Smooth interpolation between stamps at unequal intervals.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

/// The cubic spline through (x, y), with the third derivative continuous at the second node from either end
/// (not-a-knot) [deboor2001, ch. IV]: its error falls as the fourth power of the intervals, up to the ends.
class CubicSpline {
 public:
  /// @param x (N), strictly increasing, N >= 4; @param y (N)
  /// @throws std::invalid_argument otherwise.
  CubicSpline(Eigen::VectorXd x, Eigen::VectorXd y);

  /// Its value; outside the nodes that of the outermost cubic.
  double operator()(double at) const;

  /// Its values at points (M).
  Eigen::VectorXd operator()(const Eigen::VectorXd& at) const;

 private:
  Eigen::VectorXd x_, y_;
  Eigen::VectorXd curvature_;  ///< (N), second derivatives at the nodes
};

}  // namespace beamid::experiments
