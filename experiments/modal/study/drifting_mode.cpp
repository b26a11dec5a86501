#include "experiments/modal/study/drifting_mode.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/modal/envelope_line.hpp"
#include "experiments/signal/least_squares.hpp"
#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

constexpr Index terms = 4;

bool near(Complex a, Complex b, double duration) {
  constexpr double most_cycles = 4, time_constants = 3;
  const double slower = std::min(std::abs(a.real()), std::abs(b.real()));
  return std::abs(a.imag() - b.imag()) / (2 * std::numbers::pi) *
             std::min(duration, time_constants / std::max(slower, 1e-300)) <
         most_cycles;
}

/// exp(sum_k c_k x^k) at x from 0 to 1 (N).
VectorXcd drifting(const VectorXcd& c, const VectorXd& x) {
  const Eigen::ArrayXcd t = x.cast<Complex>();
  return (((c[3] * t + c[2]) * t + c[1]) * t + c[0]).exp();
}

/// c of least squares through log z, weighted by |z|.
VectorXcd through_logarithm(const VectorXcd& z, const VectorXd& x) {
  Eigen::MatrixXcd powers(z.size(), terms);
  VectorXcd right = unwrapped_logarithm(z);
  for (Index k = 0; k < z.size(); ++k) {
    const double weight = std::abs(z[k]);
    double power = weight;
    for (Index j = 0; j < terms; ++j, power *= x[k]) powers(k, j) = power;
    right[k] *= weight;
  }
  return complex_least_squares(powers, right);
}

/// d Re z / d (Re c_1, Im c_1, ...) (N x 2 terms).
MatrixXd drift_slope(const VectorXcd& z, const VectorXd& x) {
  MatrixXd slope(z.size(), 2 * terms);
  VectorXcd part = z;
  for (Index j = 0; j < terms; ++j, part.array() *= x.array().cast<Complex>()) {
    slope.col(2 * j) = part.real();
    slope.col(2 * j + 1) = -part.imag();
  }
  return slope;
}

/// Sum of squares that the best c near `c` leaves of y.
double left_by_drifting(const VectorXd& y, const VectorXd& x, VectorXcd c) {
  VectorXcd z = drifting(c, x);
  double squares = (y - z.real()).squaredNorm();
  const auto step = [&](double damping) -> VectorXd {
    const MatrixXd slope = drift_slope(z, x);
    return filters::solve_damped(slope.transpose() * slope, damping, slope.transpose() * (y - z.real()));
  };
  const auto take = [&](const VectorXd& tried) {
    VectorXcd next = c;
    for (Index j = 0; j < terms; ++j) next[j] += Complex(tried[2 * j], tried[2 * j + 1]);
    const VectorXcd there = drifting(next, x);
    const double left = (y - there.real()).squaredNorm();
    if (!(left < squares)) return filters::TriedStep{};
    const bool settled = squares - left < 1e-6 * squares;
    c = next, z = there, squares = left;
    return filters::TriedStep{1.0, settled};
  };
  filters::MarquardtDamping rule;
  rule.most = 1e6, rule.most_steps = 30;
  filters::levenberg_marquardt(rule, step, take);
  return squares;
}

}  // namespace

bool is_one_drifting_mode(const JointDecayFit& fit, std::size_t a, std::size_t b, const MatrixXd& target,
                          double interval) {
  const Index count = target.cols();
  if (!near(fit.rates[a], fit.rates[b], interval * static_cast<double>(count))) return false;
  Index channel = 0;
  (fit.shapes.col(static_cast<Index>(a)).cwiseAbs() + fit.shapes.col(static_cast<Index>(b)).cwiseAbs())
      .cwiseQuotient(fit.residual_standard_deviation.cwiseMax(1e-300))
      .maxCoeff(&channel);
  VectorXcd pair(count);
  for (Index k = 0; k < count; ++k) {
    const double time = interval * static_cast<double>(k);
    pair[k] = fit.shapes(channel, static_cast<Index>(a)) * std::exp(fit.rates[a] * time) +
              fit.shapes(channel, static_cast<Index>(b)) * std::exp(fit.rates[b] * time);
  }
  const VectorXd left_by_pair = (target.row(channel) - fit.reconstruction.row(channel)).transpose();
  const VectorXd x = VectorXd::LinSpaced(count, 0, 1);
  return left_by_drifting(left_by_pair + pair.real(), x, through_logarithm(pair, x)) <=
         left_by_pair.squaredNorm();
}

}  // namespace beamid::experiments
