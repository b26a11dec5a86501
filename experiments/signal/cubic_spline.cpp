#include "experiments/signal/cubic_spline.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

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

}  // namespace beamid::experiments
