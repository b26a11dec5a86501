// Least squares that are not linear: the loop, once for all problems.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace beamid::filters {

/// How the damping follows what the steps do.
struct MarquardtDamping {
  double first = 0.0;          ///< of the first step; 0: Gauss-Newton
  double raise = 10.0;         ///< factor after a step that was not taken ...
  double least_raised = 1e-3;  ///< ... to this at least
  double lower = 0.1;          ///< factor after a step that did what the linear problem says
  double negligible = 1e-7;    ///< what would be less is `least` instead
  double least = 0.0;
  double most = 1e12;
  int most_steps = 100;  ///< tried, whether taken or not
};

/// What became of a step.
struct TriedStep {
  double gain = 0.0;     ///< fall of the cost over what the linear problem says; above 0: taken. 1: unknown
  bool settled = false;  ///< whether it was the last that is needed
};

/// How a descent ended.
enum class DescentEnd {
  settled,
  stuck,     ///< no step lowers the cost however short: the damping would exceed `most`
  exhausted  ///< `most_steps` were tried
};

/// Levenberg-Marquardt [marquardt1963]: the steps d of
///
///     (J^T J + damping D) d = J^T r,   cost |r|^2,
///
/// D being diag(J^T J) or what else gives the unknowns one unit. A step that lowers the cost is taken, one
/// that does not is tried again shorter. The damping falls where the linear problem was right, stays where
/// the gain is less than 3/4 and grows fourfold where it is less than 1/4.
/// @param rule may be changed by `step`, whose problem may have grown
/// @param step the d of a damping from where the descent is
/// @param take tries d and moves there if the cost falls
DescentEnd levenberg_marquardt(const MarquardtDamping& rule,
                               const std::function<Eigen::VectorXd(double damping)>& step,
                               const std::function<TriedStep(const Eigen::VectorXd& step)>& take);

/// (N + damping diag N)^-1 B of N = J^T J (r x r), the columns of J scaled to one: their units differ.
Eigen::MatrixXd solve_damped(const Eigen::MatrixXd& normal, double damping, const Eigen::MatrixXd& right);

}  // namespace beamid::filters
