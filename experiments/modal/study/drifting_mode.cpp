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

/// Powers 0 to 3 of x from 0 to 1 (N x 4).
MatrixXd powers_of_time(Index count) {
  const VectorXd x = VectorXd::LinSpaced(count, 0, 1);
  MatrixXd basis(count, terms);
  basis.col(0).setOnes();
  for (Index j = 1; j < terms; ++j) basis.col(j) = basis.col(j - 1).cwiseProduct(x);
  return basis;
}

/// 1, x, a and a^2 with the amplitude a = e^(-decay x): what a rate that follows the amplitude makes of the
/// phase and of the logarithm of the amplitude, to second order.
MatrixXd powers_of_amplitude(Index count, double decay) {
  MatrixXd basis = powers_of_time(count);
  basis.col(2) = (-decay * basis.col(1).array()).exp();
  basis.col(3) = basis.col(2).cwiseAbs2();
  return basis;
}

VectorXcd drifting(const VectorXcd& c, const MatrixXd& basis) {
  return (basis.cast<Complex>() * c).array().exp();
}

/// c of least squares through log z, weighted by |z|.
VectorXcd through_logarithm(const VectorXcd& z, const MatrixXd& basis) {
  const VectorXd weight = z.cwiseAbs();
  return complex_least_squares(weight.asDiagonal() * basis.cast<Complex>(),
                               weight.asDiagonal() * unwrapped_logarithm(z));
}

/// d Re z / d (Re c_1, Im c_1, ...) (N x 2 terms).
MatrixXd drift_slope(const VectorXcd& z, const MatrixXd& basis) {
  MatrixXd slope(z.size(), 2 * terms);
  for (Index j = 0; j < terms; ++j) {
    slope.col(2 * j) = z.real().cwiseProduct(basis.col(j));
    slope.col(2 * j + 1) = -z.imag().cwiseProduct(basis.col(j));
  }
  return slope;
}

/// Sum of squares that the best c leaves of y, from that of z on.
double left_by_drifting(const VectorXd& y, const MatrixXd& basis, const VectorXcd& near) {
  VectorXcd c = through_logarithm(near, basis), z = drifting(c, basis);
  double squares = (y - z.real()).squaredNorm();
  const auto step = [&](double damping) -> VectorXd {
    const MatrixXd slope = drift_slope(z, basis);
    return filters::solve_damped(slope.transpose() * slope, damping, slope.transpose() * (y - z.real()));
  };
  const auto take = [&](const VectorXd& tried) {
    VectorXcd next = c;
    for (Index j = 0; j < terms; ++j) next[j] += Complex(tried[2 * j], tried[2 * j + 1]);
    const VectorXcd there = drifting(next, basis);
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

PairAgainstDrift pair_against_drift(const JointDecayFit& fit, std::size_t a, std::size_t b,
                                    const MatrixXd& target, double interval, Index channel) {
  const Index count = target.cols();
  VectorXcd pair(count);
  for (Index k = 0; k < count; ++k) {
    const double time = interval * static_cast<double>(k);
    pair[k] = fit.shapes(channel, static_cast<Index>(a)) * std::exp(fit.rates[a] * time) +
              fit.shapes(channel, static_cast<Index>(b)) * std::exp(fit.rates[b] * time);
  }
  const VectorXd left_by_pair = (target.row(channel) - fit.reconstruction.row(channel)).transpose(),
                 both = left_by_pair + pair.real();
  const double decay =
      -0.5 * (fit.rates[a].real() + fit.rates[b].real()) * interval * static_cast<double>(count);
  return {left_by_pair.squaredNorm(),
          std::min(left_by_drifting(both, powers_of_time(count), pair),
                   left_by_drifting(both, powers_of_amplitude(count, decay), pair))};
}

bool is_one_drifting_mode(const JointDecayFit& fit, std::size_t a, std::size_t b, const MatrixXd& target,
                          double interval) {
  if (!near(fit.rates[a], fit.rates[b], interval * static_cast<double>(target.cols()))) return false;
  Index channel = 0;
  (fit.shapes.col(static_cast<Index>(a)).cwiseAbs() + fit.shapes.col(static_cast<Index>(b)).cwiseAbs())
      .cwiseQuotient(fit.residual_standard_deviation.cwiseMax(1e-300))
      .maxCoeff(&channel);
  const PairAgainstDrift found = pair_against_drift(fit, a, b, target, interval, channel);
  return found.left_by_drift <= found.left_by_pair;
}

}  // namespace beamid::experiments
