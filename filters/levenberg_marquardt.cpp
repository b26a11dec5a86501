#include "filters/levenberg_marquardt.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace beamid::filters {

DescentEnd levenberg_marquardt(const MarquardtDamping& rule,
                               const std::function<Eigen::VectorXd(double damping)>& step,
                               const std::function<TriedStep(const Eigen::VectorXd& step)>& take) {
  constexpr double good = 0.75, poor = 0.25, after_poor = 4.0;
  double damping = rule.first;
  for (int tried = 0; tried < rule.most_steps; ++tried) {
    const TriedStep now = take(step(damping));
    if (now.settled) return DescentEnd::settled;
    if (!(now.gain > 0.0))
      damping = std::max(rule.raise * damping, rule.least_raised);
    else if (now.gain > good)
      damping = rule.lower * damping < rule.negligible ? rule.least : rule.lower * damping;
    else if (now.gain < poor)
      damping = std::max(after_poor * damping, rule.least_raised);
    if (damping > rule.most) return DescentEnd::stuck;
  }
  return DescentEnd::exhausted;
}

Eigen::MatrixXd solve_damped(const Eigen::MatrixXd& normal, double damping, const Eigen::MatrixXd& right) {
  const Eigen::VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  scaled.diagonal().array() += damping;
  return scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * right);
}

}  // namespace beamid::filters
