#include "experiments/identify/backbone/secant_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/Dense>
#include <Eigen/LU>

#include "experiments/models/estimates.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using std::numbers::pi;

/// B-splines of one degree at u by the recursion of de Boor (as many as the knots leave).
VectorXd b_splines(const VectorXd& knots, Index degree, double u) {
  const Index count = knots.size() - 1;
  VectorXd b = VectorXd::Zero(count);
  Index last = count - 1;
  while (last > 0 && !(knots[last] < knots[last + 1])) --last;
  for (Index j = 0; j <= last; ++j)
    if (knots[j] < knots[j + 1] && u >= knots[j] && (u < knots[j + 1] || j == last)) b[j] = 1;
  for (Index d = 1; d <= degree; ++d)
    for (Index j = 0; j + d < count; ++j) {
      const double left = knots[j + d] - knots[j], right = knots[j + d + 1] - knots[j + 1];
      b[j] = (left > 0 ? (u - knots[j]) / left * b[j] : 0) +
             (right > 0 ? (knots[j + d + 1] - u) / right * b[j + 1] : 0);
    }
  return b.head(count - degree);
}

}  // namespace

SecantCurve::SecantCurve(double range, Index terms)
    : range_(range),
      bend_(range / 10),
      whole_(std::log1p(10.0)),
      terms_(terms),
      degree_(std::min<Index>(3, terms - 1)) {
  if (!(range > 0) || terms < 1) throw std::invalid_argument("a force law needs a range and a term at least");
  const Index intervals = terms - degree_, count = degree_ + 1;
  VectorXd knots(terms + degree_ + 1);
  for (Index j = 0; j < knots.size(); ++j)
    knots[j] = std::clamp(static_cast<double>(j - degree_) / static_cast<double>(intervals), 0.0, 1.0);
  // each B-spline is a polynomial in an interval: through as many points as it has coefficients
  MatrixXd powers(count, count);
  VectorXd places(count);
  for (Index i = 0; i < count; ++i) {
    places[i] = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    for (Index p = 0; p < count; ++p) powers(i, p) = std::pow(places[i], static_cast<double>(p));
  }
  const auto solver = powers.partialPivLu();
  for (Index interval = 0; interval < intervals; ++interval) {
    MatrixXd values(count, count);
    for (Index i = 0; i < count; ++i)
      values.row(i) = b_splines(knots, degree_,
                                (static_cast<double>(interval) + places[i]) / static_cast<double>(intervals))
                          .segment(interval, count)
                          .transpose();
    pieces_.emplace_back(Eigen::Matrix4d::Zero());
    pieces_.back().topLeftCorner(count, count) = solver.solve(values).transpose();
  }
}

SecantCurve::Local SecantCurve::local(double x) const {
  Local found;
  found.count = degree_ + 1;
  const double size = std::abs(x), intervals = static_cast<double>(pieces_.size()),
               u = std::min(1.0, std::log1p(size / bend_) / whole_) * intervals,
               by_x = u < intervals ? intervals / ((bend_ + size) * whole_) : 0.0;
  found.first = std::min(static_cast<Index>(u), static_cast<Index>(pieces_.size()) - 1);
  const double t = u - static_cast<double>(found.first);
  const Eigen::Matrix4d& piece = pieces_[static_cast<std::size_t>(found.first)];
  for (Index m = 0; m < found.count; ++m) {
    const auto at = static_cast<std::size_t>(m);
    found.value[at] = piece(m, 0) + t * (piece(m, 1) + t * (piece(m, 2) + t * piece(m, 3)));
    found.slope[at] = by_x * (piece(m, 1) + t * (2 * piece(m, 2) + t * 3 * piece(m, 3)));
  }
  return found;
}

VectorXd SecantCurve::shape(double x, VectorXd* slope) const {
  const Local found = local(x);
  VectorXd shape = VectorXd::Zero(terms_);
  if (slope) slope->setZero(terms_);
  for (Index m = 0; m < found.count; ++m) {
    shape[found.first + m] = found.value[static_cast<std::size_t>(m)];
    if (slope) (*slope)[found.first + m] = found.slope[static_cast<std::size_t>(m)];
  }
  return shape;
}

VectorXd elastic_stiffness(const SecantCurve& curve, double amplitude) {
  constexpr int points = 96;
  VectorXd row = VectorXd::Zero(curve.terms());
  for (int i = 0; i < points; ++i) {
    const double sine = std::sin(0.5 * pi * (i + 0.5) / points);
    row += sine * sine * curve.shape(amplitude * sine);
  }
  return 2.0 / points * row;
}

VectorXd masing_stiffness(const SecantCurve& curve, double amplitude) {
  constexpr int points = 96;
  VectorXd row = VectorXd::Zero(curve.terms());
  for (int i = 0; i < points; ++i) {
    const double sine = std::sin(0.5 * pi * (i + 0.5) / points);
    const double outer = 0.5 * amplitude * (1 + sine), inner = 0.5 * amplitude * (1 - sine);
    row += sine * (outer * curve.shape(outer) - inner * curve.shape(inner));
  }
  return 2.0 / (points * amplitude) * row;
}

VectorXd masing_energy(const SecantCurve& curve, double amplitude) {
  constexpr int intervals = 128;  // Simpson's rule
  VectorXd integral = VectorXd::Zero(curve.terms());
  for (int i = 1; i <= intervals; ++i) {
    const double x = amplitude * i / intervals;
    integral += (i == intervals ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * x * curve.shape(x);
  }
  return 8.0 * amplitude / (3.0 * intervals) * integral -
         4.0 * amplitude * amplitude * curve.shape(amplitude);
}

VectorXd equivalent_damping(const SecantCurve& curve, double amplitude) {
  constexpr int points = 48;
  VectorXd row = VectorXd::Zero(curve.terms());
  for (int i = 0; i < points; ++i) {
    const double angle = 0.5 * pi * (i + 0.5) / points, cosine = std::cos(angle);
    row += cosine * cosine * curve.shape(amplitude * std::sin(angle));
  }
  return 2.0 / points * row;
}

PeriodicMotion periodic_motion(const SecantCurve& curve, const VectorXd& theta, double amplitude) {
  constexpr int points = 96;
  const auto force = [&](double x) { return x * curve.shape(x).dot(theta); };
  // x = A sin u: V(A) - V(x) gathered from A downwards, two points of Gauss in each interval
  VectorXd x(points), step(points);
  double above = amplitude, difference = 0;
  for (int i = points - 1; i >= 0; --i) {
    const double angle = 0.5 * pi * (i + 0.5) / points;
    x[i] = amplitude * std::sin(angle);
    const double middle = 0.5 * (above + x[i]), half = 0.5 * (above - x[i]), gauss = half / std::sqrt(3.0);
    difference += half * (force(middle - gauss) + force(middle + gauss));
    step[i] = 0.5 * pi / points * amplitude * std::cos(angle) / std::sqrt(2 * difference);
    above = x[i];
  }
  const double quarter = step.sum(), omega = 0.5 * pi / quarter;
  double time = 0, harmonic = 0;
  for (int i = 0; i < points; ++i) {
    harmonic += 2 / quarter * x[i] * std::sin(omega * (time + 0.5 * step[i])) * step[i];
    time += step[i];
  }
  return {omega * omega, harmonic / amplitude};
}

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
