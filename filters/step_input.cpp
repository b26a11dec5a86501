#include "filters/step_input.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

StepInput::StepInput(const VectorXd& path, Index inputs)
    : path_(path),
      inputs_(path.size() == 0 ? 0
              : inputs > 0     ? inputs
                               : path.size()) {
  if (inputs_ == 0) return;
  degree_ = path.size() / inputs_ - 1;
  if (degree_ < 0 || degree_ > highest_degree || path.size() % inputs_ != 0)
    throw std::invalid_argument("the input of a step has " + std::to_string(path.size()) +
                                " entries; expected 1 to 5 times the model's " + std::to_string(inputs_));
}

VectorXd StepInput::at(double s) const {
  VectorXd value = VectorXd::Zero(inputs_);
  for (Index j = degree_; j >= 0; --j) value = s * value + coefficient(j);
  return value;
}

VectorXd StepInput::mean() const {
  if (inputs_ == 0) return {};
  VectorXd value = coefficient(0);
  for (Index j = 1; j <= degree_; ++j) {
    const double bend = j == 1 ? 0.0 : static_cast<double>(j) / 12.0;
    value += (0.5 - bend) * coefficient(j);
  }
  return value;
}

VectorXd StepInput::slope() const {
  VectorXd value = VectorXd::Zero(inputs_);
  for (Index j = 1; j <= degree_; ++j) value += coefficient(j);
  return value;
}

using std::numbers::pi;

namespace {

constexpr int degree = StepInput::highest_degree;
constexpr Index reach = 16, fewest = 8;  // samples to each side; even intervals of a run
constexpr double path_rounding = 1e-9;   // eps, of C's diagonal

// The covariance of the signal whose power is 1, 250 and 1e5 per unit of band below 0.85, 0.4 and 0.1 of the
// Nyquist frequency, at a distance in samples.
double covariance(double distance) {
  double sum = 0.0;
  for (const auto& [band, power] : {std::pair{0.85, 1.0}, {0.4, 1e2}, {0.1, 1e4}}) {
    const double x = pi * band * distance;
    sum += power * (x == 0.0 ? 1.0 : std::sin(x) / x);
  }
  return sum;
}

// p_j of a step with `before` samples up to its first and `behind` from its second: (d + 1) x (before +
// behind).
MatrixXd weights(Index before, Index behind) {
  const Index n = before + behind;
  VectorXd points(degree + 1);
  for (int i = 0; i <= degree; ++i) points[i] = 0.5 * (1.0 - std::cos(pi * i / degree));
  MatrixXd among(n, n), towards(n, degree + 1), powers(degree + 1, degree + 1);
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) among(i, j) = covariance(static_cast<double>(i - j));
    for (int j = 0; j <= degree; ++j)
      towards(i, j) = covariance(static_cast<double>(i - before + 1) - points[j]);
  }
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; j <= degree; ++j) powers(i, j) = std::pow(points[i], j);
  among.diagonal() *= 1.0 + path_rounding;
  MatrixXd values = among.ldlt().solve(towards);
  for (const auto& [point, sample] : {std::pair{Index{0}, before - 1}, {Index{degree}, before}}) {
    values.col(point).setZero();
    values(sample, point) = 1.0;
  }
  return powers.partialPivLu().solve(values.transpose());
}

// Whether each interval is even.
std::vector<bool> even_intervals(const VectorXd& time, double tolerance) {
  const Index steps = time.size() - 1;
  VectorXd intervals = time.tail(steps) - time.head(steps);
  std::vector<double> sorted(intervals.begin(), intervals.end());
  std::nth_element(sorted.begin(), sorted.begin() + steps / 2, sorted.end());
  const double median = sorted[static_cast<std::size_t>(steps / 2)];
  std::vector<bool> even(static_cast<std::size_t>(steps));
  for (Index k = 0; k < steps; ++k)
    even[static_cast<std::size_t>(k)] = std::abs(intervals[k] - median) <= tolerance;
  return even;
}

}  // namespace

InputPaths straight_path(const MatrixXd& samples) {
  const Index m = samples.rows(), n = samples.cols();
  InputPaths path{MatrixXd::Zero(2 * m, n), 1};
  path.columns.topRows(m) = samples;
  if (n > 1) path.columns.bottomRows(m).leftCols(n - 1) = samples.rightCols(n - 1) - samples.leftCols(n - 1);
  return path;
}

InputPaths band_limited_path(const VectorXd& time, const MatrixXd& samples, double tolerance) {
  const Index m = samples.rows(), n = samples.cols();
  InputPaths path{MatrixXd::Zero((degree + 1) * m, n), degree};
  path.columns.topRows(2 * m) = straight_path(samples).columns;
  if (n < 2) return path;
  const std::vector<bool> even = even_intervals(time, tolerance);
  std::map<std::pair<Index, Index>, MatrixXd> known;
  for (Index first = 0; first < n - 1;) {
    Index last = first;  // sample behind the run of even intervals
    while (last < n - 1 && even[static_cast<std::size_t>(last)]) ++last;
    for (Index k = first; last - first >= fewest && k < last; ++k) {
      const std::pair place{std::min(reach, k - first + 1), std::min(reach, last - k)};
      const auto [found, is_new] = known.try_emplace(place);
      if (is_new) found->second = weights(place.first, place.second);
      const MatrixXd coefficients =
          samples.middleCols(k - place.first + 1, place.first + place.second) * found->second.transpose();
      path.columns.col(k) = coefficients.reshaped();
      path.columns.col(k).head(m) = samples.col(k);
      ++path.band_limited;
    }
    first = std::max(last, first + 1);
  }
  return path;
}

InputPaths input_path(int degree_wanted, const VectorXd& time, const MatrixXd& samples, double tolerance) {
  if (degree_wanted == 0) return {samples, 0};
  return degree_wanted == 1 ? straight_path(samples) : band_limited_path(time, samples, tolerance);
}

InputPaths in_parts(const InputPaths& path, int parts) {
  const Index m = path.columns.rows() / (path.degree + 1), n = path.columns.cols();
  InputPaths finer{MatrixXd((path.degree + 1) * m, (n - 1) * parts + 1), path.degree,
                   path.band_limited * parts};
  const double h = 1.0 / parts;
  for (Index k = 0; k < finer.columns.cols(); ++k) {
    // sum_j p_j (a + h s)^j about a: Horner's scheme, again and again
    finer.columns.col(k) = path.columns.col(k / parts);
    auto p = finer.columns.col(k).reshaped(m, path.degree + 1);
    const double a = h * static_cast<double>(k % parts);
    for (int i = 0; i < path.degree; ++i)
      for (int j = path.degree - 1; j >= i; --j) p.col(j) += a * p.col(j + 1);
    for (int j = 1; j <= path.degree; ++j) p.col(j) *= std::pow(h, j);
  }
  return finer;
}

}  // namespace beamid::filters
