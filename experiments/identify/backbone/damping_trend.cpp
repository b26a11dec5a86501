#include "experiments/identify/backbone/damping_trend.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/models/estimates.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using std::numbers::pi;

// Weighed least squares of one law, and what it leaves: the mean square over its freedom.
struct Fit {
  VectorXd coefficients;
  double left = 0, deviation = 0;  // of the last coefficient
};

Fit fitted(const MatrixXd& columns, const VectorXd& damping, const VectorXd& deviation) {
  const VectorXd weight = deviation.cwiseInverse();
  const MatrixXd a = weight.asDiagonal() * columns;
  const VectorXd b = weight.cwiseProduct(damping);
  Fit fit{a.colPivHouseholderQr().solve(b)};
  fit.left = (b - a * fit.coefficients).squaredNorm() / static_cast<double>(a.rows() - a.cols());
  const MatrixXd covariance = (a.transpose() * a).inverse() * std::max(1.0, fit.left);
  fit.deviation = std::sqrt(covariance(a.cols() - 1, a.cols() - 1));
  return fit;
}

}  // namespace

DampingTrend damping_trend(const std::vector<AmplitudeWindow>& windows) {
  constexpr std::size_t fewest = 5;
  constexpr double by_chance = 6.0, change = 1.3, most_left = 0.25, sure = 3.0;
  DampingTrend trend;
  if (windows.size() < fewest) return trend;
  const auto n = static_cast<Index>(windows.size());
  VectorXd damping(n), deviation(n), amplitude(n), omega(n);
  for (Index i = 0; i < n; ++i) {
    const AmplitudeWindow& w = windows[static_cast<std::size_t>(i)];
    damping[i] = w.damping, deviation[i] = std::max(w.damping_deviation, 1e-12 * std::abs(w.damping));
    amplitude[i] = w.amplitude, omega[i] = 2.0 * pi * w.frequency_hz;
  }
  const VectorXd one = VectorXd::Ones(n);
  const Fit constant = fitted(one, damping, deviation);
  trend.constant = constant.coefficients[0];
  // Of the windows that know their damping: small ones do not.
  double least = damping[0], most = damping[0];
  for (Index i = 0; i < n; ++i)
    if (quantile_95 * deviation[i] < 0.2 * std::abs(damping[i]))
      least = std::min(least, damping[i]), most = std::max(most, damping[i]);
  if (!(constant.left > by_chance) || most < change * least) return trend;
  trend.kind = DampingTrend::Kind::other;
  MatrixXd friction(n, 2), drag(n, 2);
  friction << one, (4.0 / pi * (omega.cwiseProduct(amplitude)).cwiseInverse());
  drag << one, (8.0 / (3.0 * pi) * omega.cwiseProduct(amplitude));
  const Fit by_friction = fitted(friction, damping, deviation), by_drag = fitted(drag, damping, deviation);
  const bool rubs = by_friction.left < by_drag.left;
  const Fit& best = rubs ? by_friction : by_drag;
  if (best.left > most_left * constant.left || !(best.coefficients[1] > sure * best.deviation)) return trend;
  trend.kind = rubs ? DampingTrend::Kind::friction : DampingTrend::Kind::drag;
  trend.constant = best.coefficients[0], trend.coefficient = best.coefficients[1];
  trend.deviation = best.deviation;
  return trend;
}

std::string damping_trend_text(const DampingTrend& trend, const std::vector<AmplitudeWindow>& windows) {
  if (trend.kind == DampingTrend::Kind::none) return {};
  const std::string change = fmt::format(
      "The damping depends on the amplitude: C is {:.3g} N s/m at {:.3g} mm and {:.3g} at {:.3g} mm",
      windows.front().damping, 1e3 * windows.front().amplitude, windows.back().damping,
      1e3 * windows.back().amplitude);
  const double half = quantile_95 * trend.deviation;
  switch (trend.kind) {
    case DampingTrend::Kind::friction:
      return fmt::format(
          "{}, as of a dry friction of {:.3g} +- {:.2g} N beside {:.3g} N s/m. No one C holds for the whole "
          "record.",
          change, trend.coefficient, half, trend.constant);
    case DampingTrend::Kind::drag:
      return fmt::format(
          "{}, as of a drag {:.3g} +- {:.2g} N s2/m2 times the square of the velocity, or of a spring's "
          "loop, beside {:.3g} N s/m. No one C holds for the whole record.",
          change, trend.coefficient, half, trend.constant);
    default:
      return change +
             ", neither as of friction nor as of drag: a loop of the spring, another mode beside this one "
             "(beats), or motion that is no free decay.";
  }
}

}  // namespace beamid::experiments
