#include "experiments/signal/interpolation.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/QR>

#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

CubicSpline::CubicSpline(VectorXd x, VectorXd y) : x_(std::move(x)), y_(std::move(y)), curvature_(x_.size()) {
  const Index n = x_.size(), last = n - 1;
  if (n < 4 || y_.size() != n)
    throw std::invalid_argument("spline through " + std::to_string(n) + " nodes with " +
                                std::to_string(y_.size()) +
                                " values; expected 4 or more, and as many values");
  const VectorXd h = x_.tail(last) - x_.head(last);
  if (!(h.minCoeff() > 0)) throw std::invalid_argument("spline nodes; expected them strictly increasing");
  const VectorXd slope = (y_.tail(last) - y_.head(last)).cwiseQuotient(h);
  // h_(i-1) M_(i-1) + 2 (h_(i-1) + h_i) M_i + h_i M_(i+1) = 6 (slope_i - slope_(i-1)) for 0 < i < last, from
  // which the ends are eliminated: M_0 = M_1 + (M_1 - M_2) h_0 / h_1, and so at the other end.
  VectorXd below = h.head(last - 1), diagonal = 2 * (h.head(last - 1) + h.tail(last - 1)),
           above = h.tail(last - 1), right = 6 * (slope.tail(last - 1) - slope.head(last - 1));
  const double first_ratio = h[0] / h[1], last_ratio = h[last - 1] / h[last - 2];
  diagonal[0] += h[0] * (1 + first_ratio);
  above[0] -= h[0] * first_ratio;
  diagonal[last - 2] += h[last - 1] * (1 + last_ratio);
  below[last - 2] -= h[last - 1] * last_ratio;
  for (Index i = 1; i < last - 1; ++i) {
    const double factor = below[i] / diagonal[i - 1];
    diagonal[i] -= factor * above[i - 1];
    right[i] -= factor * right[i - 1];
  }
  curvature_[last - 1] = right[last - 2] / diagonal[last - 2];
  for (Index i = last - 3; i >= 0; --i)
    curvature_[i + 1] = (right[i] - above[i] * curvature_[i + 2]) / diagonal[i];
  curvature_[0] = curvature_[1] + (curvature_[1] - curvature_[2]) * first_ratio;
  curvature_[last] = curvature_[last - 1] + (curvature_[last - 1] - curvature_[last - 2]) * last_ratio;
}

double CubicSpline::operator()(double at) const {
  const Index next = std::upper_bound(x_.data() + 1, x_.data() + x_.size() - 1, at) - x_.data(), i = next - 1;
  const double h = x_[next] - x_[i], a = (x_[next] - at) / h, b = (at - x_[i]) / h;
  return a * y_[i] + b * y_[next] +
         ((a * a * a - a) * curvature_[i] + (b * b * b - b) * curvature_[next]) * h * h / 6;
}

VectorXd CubicSpline::operator()(const VectorXd& at) const {
  return at.unaryExpr([this](double point) { return (*this)(point); });
}

VectorXd shifted(const VectorXd& time, const VectorXd& signal, double by) {
  if (by == 0.0) return signal;
  constexpr Index margin = 16;  // the interpolation's reach
  const Index count = time.size();
  if (signal.array().isFinite().count() < 4)
    throw std::invalid_argument("fewer than four samples; expected a signal to shift");
  const BandLimited between(time, bridged_straight(signal));
  VectorXd missing_before = VectorXd::Zero(count + 1);  // how many of the first k samples are not there
  for (Index k = 0; k < count; ++k)
    missing_before[k + 1] = missing_before[k] + (std::isfinite(signal[k]) ? 0.0 : 1.0);
  VectorXd result = VectorXd::Constant(count, std::numeric_limits<double>::quiet_NaN());
  std::vector<Index> kept;
  for (Index k = 0; k < count; ++k) {
    const auto next = std::upper_bound(time.begin(), time.end(), time[k] + by) - time.begin();
    if (next < margin || next + margin > count) continue;
    if (missing_before[next + margin] == missing_before[next - margin]) kept.push_back(k);
  }
  if (kept.empty()) return result;
  result(kept) = between(time(kept).array() + by);
  return result;
}

namespace {

constexpr Index kernel_reach = 16;  // nodes to either side
using std::numbers::pi;

double sinc(double u) {
  return std::abs(u) < 1e-9 ? 1 : std::sin(pi * u) / (pi * u);
}

/// h(u), 100 dB down from 0.6 of the node rate on.
double exact_kernel(double u) {
  constexpr double beta = 10.06;
  const double edge = u / static_cast<double>(kernel_reach);
  if (std::abs(edge) >= 1) return 0;
  static const double top = std::cyl_bessel_i(0, beta);
  return sinc(u) * std::cyl_bessel_i(0, beta * std::sqrt(1 - edge * edge)) / top;
}

/// h(u) from a table, to 2e-8.
double kernel(double u) {
  constexpr double per_node = 8192;
  static const std::vector<double> table = [] {
    std::vector<double> band_limited_values;
    for (double k = 0; k <= per_node * static_cast<double>(kernel_reach) + 1; ++k)
      band_limited_values.push_back(exact_kernel(k / per_node));
    return band_limited_values;
  }();
  const double place = std::abs(u) * per_node;
  if (place >= per_node * static_cast<double>(kernel_reach)) return 0;
  const auto left = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(left);
  return (1 - share) * table[left] + share * table[left + 1];
}

/// Rows of A: the weights of 2 kernel_reach nodes in one value.
struct Row {
  Index first;
  Eigen::Matrix<double, 2 * kernel_reach, 1> weight;
};

Row row_at(double place) {  // in nodes
  Row row{static_cast<Index>(std::floor(place)) - kernel_reach + 1, {}};
  for (Index j = 0; j < 2 * kernel_reach; ++j)
    row.weight[j] = kernel(place - static_cast<double>(row.first + j));
  return row;
}

VectorXd band_limited_values(const std::vector<Row>& rows, const VectorXd& nodes) {
  VectorXd result(static_cast<Index>(rows.size()));
  for (Index k = 0; k < result.size(); ++k)
    result[k] = rows[k].weight.dot(nodes.segment<2 * kernel_reach>(rows[k].first));
  return result;
}

VectorXd transposed(const std::vector<Row>& rows, const VectorXd& right, Index nodes) {
  VectorXd result = VectorXd::Zero(nodes);
  for (Index k = 0; k < right.size(); ++k)
    result.segment<2 * kernel_reach>(rows[k].first) += right[k] * rows[k].weight;
  return result;
}

/// Goes on with a signal (N), known up to `known`, as the linear prediction of order 32 that its last known
/// values obey best: exact for up to 16 decaying or growing sines. Neither end counts as known.
void predict(VectorXd& signal, Index known) {
  constexpr Index most_order = 32, most_values = 1000;
  const Index band_limited_values = std::min(known - 2 * kernel_reach, most_values),
              order = std::min(most_order, band_limited_values / 3);
  if (order < 2) return;
  Eigen::MatrixXd past(band_limited_values - order, order);
  for (Index k = 0; k < past.rows(); ++k)
    past.row(k) = signal.segment(known - band_limited_values + k, order).transpose();
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(1e-3);
  const VectorXd weight =
      solver.compute(past).solve(signal.segment(known - band_limited_values + order, past.rows()));
  const double largest =
      signal.segment(known - band_limited_values, band_limited_values).cwiseAbs().maxCoeff();
  for (Index k = known; k < signal.size(); ++k)
    signal[k] = std::clamp(weight.dot(signal.segment(k - order, order)), -2 * largest, 2 * largest);
}

/// A (N x P) and its least squares.
struct Interpolation {
  std::vector<Row> rows;
  int iterations = 0;

  /// Minimises |A x - y|^2 + stiffness |x - x_0|^2 from the nodes x_0 on: what the stamps hardly see stays
  /// where it was. Repeated, it leaves stiffness^n of what they do see. What is left of the signal.
  VectorXd solve(const VectorXd& signal, VectorXd& nodes) {
    constexpr double stiffness = 0.01;
    const VectorXd begun = nodes;
    VectorXd left = signal - band_limited_values(rows, nodes),
             gradient = transposed(rows, left, nodes.size()), direction = gradient;
    double size = gradient.squaredNorm();
    constexpr int most = 200;
    const double enough = 1e-9 * signal.norm();
    for (int k = 0; k < most && left.norm() > enough && std::sqrt(size) > enough; ++k, ++iterations) {
      const VectorXd along = band_limited_values(rows, direction);
      const double step = size / std::max(along.squaredNorm() + stiffness * direction.squaredNorm(), 1e-300);
      nodes += step * direction;
      left -= step * along;
      gradient = transposed(rows, left, nodes.size()) - stiffness * (nodes - begun);
      const double next = gradient.squaredNorm();
      direction = gradient + next / size * direction;
      size = next;
    }
    return left;
  }
};

}  // namespace

BandLimited::BandLimited(VectorXd time, const VectorXd& signal) {
  const CubicSpline spline(time, signal);
  const Index count = time.size();
  const double last = time[count - 1];
  const double widest = (time.tail(count - 1) - time.head(count - 1)).maxCoeff(),
               mean_rate = static_cast<double>(count - 1) / (last - time[0]);
  const double between = std::ceil((last - time[0]) * std::min(mean_rate, 1 / widest) - 1e-6);
  rate_ = between / (last - time[0]);
  first_ = time[0] - static_cast<double>(kernel_reach) / rate_;
  nodes_.resize(static_cast<Index>(between) + 1 + 2 * kernel_reach);
  for (Index j = 0; j < nodes_.size(); ++j) {
    const double at = first_ + static_cast<double>(j) / rate_;
    if (at < time[0])
      nodes_[j] = 2 * signal[0] - spline(std::min(2 * time[0] - at, last));
    else if (at > last)
      nodes_[j] = 2 * signal[count - 1] - spline(std::max(2 * last - at, time[0]));
    else
      nodes_[j] = spline(at);
  }
  Interpolation interpolation;
  for (const double at : time) interpolation.rows.push_back(row_at((at - first_) * rate_));
  VectorXd left = interpolation.solve(signal, nodes_);
  constexpr int rounds = 3;  // each leaves less of what the one before had wrong at the ends
  for (int round = 0; round < rounds && nodes_.size() > 10 * kernel_reach; ++round) {
    for (int end = 0; end < 2; ++end) {
      nodes_.reverseInPlace();
      predict(nodes_, nodes_.size() - 2 * kernel_reach);
    }
    left = interpolation.solve(signal, nodes_);
  }
  iterations_ = interpolation.iterations;
  misfit_ = left.norm() / std::max((signal.array() - signal.mean()).matrix().norm(), 1e-300);
}

VectorXd BandLimited::operator()(const VectorXd& at) const {
  VectorXd result(at.size());
  for (Index k = 0; k < at.size(); ++k) {
    const Row row = row_at((at[k] - first_) * rate_);
    const Index from = std::clamp<Index>(row.first, 0, nodes_.size() - 2 * kernel_reach);
    result[k] = row.weight.dot(nodes_.segment<2 * kernel_reach>(from));
  }
  return result;
}

double BandLimited::kernel_error(double frequency) {
  double worst = 0;
  for (int part = 0; part <= 20; ++part) {
    const double u = kernel_reach + 0.05 * part;
    const Row row = row_at(u);
    std::complex<double> sum = -1;
    for (Index j = 0; j < 2 * kernel_reach; ++j)
      sum += row.weight[j] * std::polar(1.0, 2 * pi * frequency * (static_cast<double>(row.first + j) - u));
    worst = std::max(worst, std::abs(sum));
  }
  return worst;
}

double linear_interpolation_error(double frequency) {
  return 1 - std::cos(pi * frequency);
}

}  // namespace beamid::experiments
