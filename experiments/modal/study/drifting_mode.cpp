#include "experiments/modal/study/drifting_mode.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/modal/envelope_line.hpp"
#include "experiments/signal/least_squares.hpp"

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

/// Sum of squares that the best c near `c` leaves of y: Gauss-Newton, damped where it does not descend.
double left_by_drifting(const VectorXd& y, const VectorXd& x, VectorXcd c) {
  VectorXcd z = drifting(c, x);
  double squares = (y - z.real()).squaredNorm(), damping = 1e-6;
  for (int step = 0; step < 30 && damping < 1e6; ++step) {
    MatrixXd slope(y.size(), 2 * terms);
    VectorXcd part = z;
    for (Index j = 0; j < terms; ++j, part.array() *= x.array().cast<Complex>()) {
      slope.col(2 * j) = part.real();
      slope.col(2 * j + 1) = -part.imag();
    }
    MatrixXd normal = slope.transpose() * slope;
    normal.diagonal() *= 1 + damping;
    const VectorXd move = normal.ldlt().solve(slope.transpose() * (y - z.real()));
    VectorXcd next = c;
    for (Index j = 0; j < terms; ++j) next[j] += Complex(move[2 * j], move[2 * j + 1]);
    const VectorXcd there = drifting(next, x);
    const double left = (y - there.real()).squaredNorm();
    if (!(left < squares)) {
      damping *= 10;
      continue;
    }
    const bool settled = squares - left < 1e-6 * squares;
    c = next, z = there, squares = left, damping *= 0.1;
    if (settled) break;
  }
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
