#include "experiments/modal/line_noise.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "experiments/signal/fast_length.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::MatrixXcd, Eigen::VectorXd, Eigen::VectorXcd;

/// Between lines and instants: a grid that resolves the square of what the lines hold.
class Instants {
 public:
  Instants(const VectorXd& frequency_hz, double decay) : lines_(frequency_hz.size()) {
    const double line = (frequency_hz[lines_ - 1] - frequency_hz[0]) / static_cast<double>(lines_ - 1);
    first_ = static_cast<Index>(std::lround(frequency_hz[0] / line));
    const Index count = even_fast_length_around(4 * (first_ + lines_));
    share_.resize(count);
    for (Index i = 0; i < count; ++i)
      share_[i] = std::exp(-2 * decay * (static_cast<double>(i) + 0.5) / static_cast<double>(count));
    share_ /= share_.sum();
    transform_.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  }

  /// w^2 / |w|^2
  const VectorXd& share() const { return share_; }

  /// Re sum_k x_k e^(i 2 pi f_k t)
  VectorXd in_time(const VectorXcd& x) {
    const Index count = share_.size();
    VectorXcd half = VectorXcd::Zero(count / 2 + 1);
    half.segment(first_, lines_) = (0.5 * static_cast<double>(count)) * x;
    if (first_ == 0) half[0] *= 2;
    VectorXd result(count);
    transform_.inv(result, half, count);
    return result;
  }

  /// sum_n x(t_n) e^(-i 2 pi f_k t_n)
  VectorXcd at_lines(const VectorXd& x) {
    VectorXcd half;
    transform_.fwd(half, x);
    return half.segment(first_, lines_);
  }

 private:
  Index lines_, first_ = 0;
  VectorXd share_;
  Eigen::FFT<double> transform_;
};

/// Sums over the lines around each, as many at the ends.
VectorXd around(const VectorXd& values, Index wide) {
  const Index count = values.size(), length = std::min(wide, count);
  VectorXd sums(count);
  for (Index k = 0; k < count; ++k)
    sums[k] = values.segment(std::clamp<Index>(k - length / 2, 0, count - length), length).sum();
  return sums;
}

}  // namespace

MatrixXd covariance_under(const LineNoise& noise, const VectorXd& frequency_hz, const MatrixXd& jacobian,
                          const MatrixXd& inverse, const VectorXd& left, const VectorXd& explained) {
  constexpr int passes = 3;  // the second is right but for outputs of unequal noise
  constexpr double freedom = 8, least = 0.1;
  const Index lines = frequency_hz.size(), outputs = left.size() / (2 * lines), n = jacobian.cols();
  Instants instants(frequency_hz, noise.decay);
  const VectorXd unit = noise.size.size() > 0 ? noise.size : VectorXd::Ones(lines);
  // Lines for one that is independent: sum of |correlation|^2.
  const double dependent = noise.decay > 0 ? noise.decay / std::tanh(noise.decay) : 1;
  const auto wide = static_cast<Index>(std::ceil(0.5 * freedom * dependent)) + n / outputs;
  const MatrixXd influence = jacobian * inverse;
  const auto complex_rows = [&](const MatrixXd& stacked, Index o) -> MatrixXcd {
    return stacked.middleRows(2 * o * lines, lines).cast<Complex>() +
           Complex(0, 1) * stacked.middleRows((2 * o + 1) * lines, lines).cast<Complex>();
  };
  MatrixXd size = unit.replicate(1, outputs), covariance;
  for (int pass = 0;; ++pass) {
    covariance = MatrixXd::Zero(n, n);
    std::vector<MatrixXcd> shared;  // of each output, E x d_k (F x n)
    for (Index o = 0; o < outputs; ++o) {
      const MatrixXcd weighted = size.col(o).asDiagonal() * complex_rows(influence, o);
      MatrixXd moves(instants.share().size(), n);
      for (Index i = 0; i < n; ++i) moves.col(i) = instants.in_time(weighted.col(i));
      const MatrixXd in_window = instants.share().asDiagonal() * moves;
      covariance += moves.transpose() * in_window;
      shared.emplace_back(lines, n);
      for (Index i = 0; i < n; ++i)
        shared.back().col(i) = size.col(o).cast<Complex>().cwiseProduct(instants.at_lines(in_window.col(i)));
    }
    double fewest = std::numeric_limits<double>::infinity();
    MatrixXd next = size;
    for (Index o = 0; o < outputs; ++o) {
      const MatrixXcd slope = complex_rows(jacobian, o);
      const VectorXd taken = slope.conjugate().cwiseProduct(shared[o]).real().rowwise().sum(),
                     moved = (slope * covariance).conjugate().cwiseProduct(slope).real().rowwise().sum();
      const VectorXd power = unit.cwiseAbs2(), own = size.col(o).cwiseAbs2();
      const VectorXd expected = (own - 2 * taken + moved).cwiseMax(0);
      const auto of_lines = [&](const VectorXd& squares) -> VectorXd {
        return around((squares.segment(2 * o * lines, lines) + squares.segment((2 * o + 1) * lines, lines))
                          .cwiseQuotient(power),
                      wide);
      };
      const VectorXd all = of_lines(left.cwiseAbs2()),
                     found = (all - of_lines(explained)).cwiseMax(least * all);
      const VectorXd free = 2 / dependent * around(expected.cwiseQuotient(own), wide);
      const VectorXd student = free.unaryExpr(
          [](double f) { return f > 2 ? f / (f - 2) : std::numeric_limits<double>::quiet_NaN(); });
      next.col(o) =
          own.cwiseProduct(found).cwiseQuotient(around(expected.cwiseQuotient(power), wide)).cwiseSqrt();
      if (pass + 2 == passes) next.col(o) = next.col(o).cwiseProduct(student.cwiseSqrt());
      fewest = std::min(fewest, free.minCoeff());
    }
    if (pass + 1 == passes) return covariance;
    size = std::move(next);
  }
}

}  // namespace beamid::experiments
