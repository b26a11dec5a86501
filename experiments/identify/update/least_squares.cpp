#include "experiments/identify/update/least_squares.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr int most_iterations = 200;
// Coordinates are logarithms, alike in scale: what hardly changes anything is damped as the others are, in
// part.
constexpr double least_scale = 1e-3, least_damping = 1e-10;
constexpr double shortest_step = 1e-11, least_gain = 1e-15;

std::optional<FitResidual::Value> value_at(const FitResidual& residual, const VectorXd& x, bool jacobian) {
  try {
    FitResidual::Value value = residual.at(x, jacobian);
    if (value.residual.allFinite()) return value;
  } catch (const std::runtime_error&) {
  } catch (const std::invalid_argument&) {  // a value that the structure cannot have
  }
  return std::nullopt;
}

std::vector<bool> held_by_bounds(const SearchSpace& space, const VectorXd& x, const VectorXd& gradient) {
  std::vector<bool> on_bound(static_cast<std::size_t>(x.size()));
  for (Index j = 0; j < x.size(); ++j)
    on_bound[static_cast<std::size_t>(j)] =
        (x[j] <= space.lower()[j] && gradient[j] >= 0.0) || (x[j] >= space.upper()[j] && gradient[j] <= 0.0);
  return on_bound;
}

VectorXd step_from(const MatrixXd& normal, const VectorXd& gradient, const std::vector<bool>& on_bound,
                   double damping) {
  MatrixXd damped = normal;
  VectorXd right = -gradient;
  for (Index j = 0; j < right.size(); ++j) {
    damped(j, j) += damping * std::max(normal(j, j), least_scale * normal.diagonal().maxCoeff()) + 1e-300;
    if (!on_bound[static_cast<std::size_t>(j)]) continue;
    damped.row(j).setZero();
    damped.col(j).setZero();
    damped(j, j) = 1.0;
    right[j] = 0.0;
  }
  return damped.ldlt().solve(right);
}

}  // namespace

std::optional<Fit> least_squares(const FitResidual& residual, const VectorXd& start) {
  const SearchSpace& space = residual.space();
  VectorXd x = start.cwiseMax(space.lower()).cwiseMin(space.upper());
  auto value = value_at(residual, x, true);
  if (!value) return std::nullopt;
  // Of a large system, finding the modes is what costs, and most steps are taken.
  const bool slopes_apart = residual.model().dense();
  const double enough = slopes_apart ? 0.0 : 1e-7;  // of chi^2, where modes have fewer digits
  Fit fit;
  int small_gains = 0;
  const auto step = [&](double damping) -> VectorXd {
    const MatrixXd normal = value->jacobian.transpose() * value->jacobian;
    const VectorXd gradient = value->jacobian.transpose() * value->residual;
    return step_from(normal, gradient, held_by_bounds(space, x, gradient), damping);
  };
  const auto take = [&](const VectorXd& tried) {
    const double length = tried.cwiseAbs().maxCoeff();
    if (!std::isfinite(length)) return filters::TriedStep{};
    const VectorXd there =
        (x + std::min(1.0, (space.longest_step().array() / tried.array().abs()).minCoeff()) * tried)
            .cwiseMax(space.lower())
            .cwiseMin(space.upper());
    auto next = value_at(residual, there, !slopes_apart);
    const double before = value->chi_square();
    if (!next || !(next->chi_square() <= before)) return filters::TriedStep{0.0, length < 1e-8};
    if (slopes_apart) next = value_at(residual, there, true);
    const double gain = before - next->chi_square(), went = (there - x).cwiseAbs().maxCoeff();
    small_gains = gain <= 1e-10 * before ? small_gains + 1 : 0;
    x = there;
    value = std::move(next);
    return filters::TriedStep{1.0, went < shortest_step ||
                                       gain <= std::max(least_gain * before, enough * (1.0 + before)) ||
                                       small_gains > 3};
  };
  filters::MarquardtDamping rule;
  rule.first = 1e-2, rule.raise = 5.0, rule.least_raised = 0.0;
  rule.least = rule.negligible = least_damping, rule.most_steps = most_iterations;
  fit.converged = filters::levenberg_marquardt(rule, step, take) != filters::DescentEnd::exhausted;
  fit.on_bound = held_by_bounds(space, x, value->jacobian.transpose() * value->residual);
  fit.x = std::move(x);
  fit.value = std::move(*value);
  return fit;
}

}  // namespace beamid::experiments
