#include "experiments/modal/residue_fit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <unsupported/Eigen/FFT>

#include "experiments/signal/toolbox.hpp"
#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

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

namespace {

using Complex = std::complex<double>;

constexpr Complex i1{0, 1};

VectorXcd points(const VectorXd& frequency_hz, double shift) {
  return (2 * std::numbers::pi * i1 * frequency_hz.cast<Complex>()).array() + shift;
}

/// Columns of Re R_1, Im R_1, ..., U, L (F x 2K + 2).
MatrixXcd basis(const VectorXcd& s, int power, const std::vector<Complex>& rates) {
  const auto count = static_cast<Index>(rates.size());
  MatrixXcd columns(s.size(), 2 * count + 2);
  for (Index k = 0; k < s.size(); ++k) {
    const Complex factor = std::pow(s[k], power);
    for (Index m = 0; m < count; ++m) {
      const Complex a = 1.0 / (s[k] - rates[m]), b = 1.0 / (s[k] - std::conj(rates[m]));
      columns(k, 2 * m) = factor * (a + b);
      columns(k, 2 * m + 1) = factor * i1 * (a - b);
    }
    columns(k, 2 * count) = factor;
    columns(k, 2 * count + 1) = factor / (s[k] * s[k]);
  }
  return columns;
}

MatrixXd stacked(const MatrixXcd& columns) {
  MatrixXd both(2 * columns.rows(), columns.cols());
  both << columns.real(), columns.imag();
  return both;
}

ResidueFit fit(const VectorXcd& s, const MatrixXcd& responses, int power, const std::vector<Complex>& rates) {
  const MatrixXcd columns = basis(s, power, rates);
  const auto count = static_cast<Index>(rates.size());
  const MatrixXd solved = least_squares(stacked(columns), stacked(responses.transpose()));
  ResidueFit found{rates,
                   MatrixXcd(responses.rows(), count),
                   solved.row(2 * count),
                   solved.row(2 * count + 1),
                   (columns * solved.cast<Complex>()).transpose(),
                   {}};
  for (Index m = 0; m < count; ++m)
    found.residues.col(m) = (solved.row(2 * m).cast<Complex>() + i1 * solved.row(2 * m + 1)).transpose();
  return found;
}

/// Derivatives by all parameters (2 p F x n), in the order of ResidueFit::covariance.
MatrixXd jacobian(const VectorXcd& s, int power, const ResidueFit& at) {
  const auto modes = static_cast<Index>(at.rates.size());
  const Index outputs = at.residues.rows(), lines = s.size(), own = 2 * modes + 2;
  MatrixXd result = MatrixXd::Zero(2 * outputs * lines, 2 * modes + outputs * own);
  const MatrixXd linear = stacked(basis(s, power, at.rates));
  for (Index o = 0; o < outputs; ++o) {
    MatrixXcd of_poles(lines, 2 * modes);
    for (Index k = 0; k < lines; ++k)
      for (Index m = 0; m < modes; ++m) {
        const Complex factor = std::pow(s[k], power), a = s[k] - at.rates[m],
                      b = s[k] - std::conj(at.rates[m]);
        const Complex p = factor * at.residues(o, m) / (a * a),
                      q = factor * std::conj(at.residues(o, m)) / (b * b);
        of_poles(k, 2 * m) = i1 * (p - q);
        of_poles(k, 2 * m + 1) = -(p + q);
      }
    result.block(2 * o * lines, 0, 2 * lines, 2 * modes) = stacked(of_poles);
    result.block(2 * o * lines, 2 * modes + o * own, 2 * lines, own) = linear;
  }
  return result;
}

VectorXd residual(const MatrixXcd& responses, const ResidueFit& at) {
  const Index lines = responses.cols();
  VectorXd left(2 * responses.size());
  for (Index o = 0; o < responses.rows(); ++o) {
    const VectorXcd difference = (responses.row(o) - at.reproduced.row(o)).transpose();
    left.segment(2 * o * lines, 2 * lines) << difference.real(), difference.imag();
  }
  return left;
}

/// J^T J of all parameters, J^T r, and J itself.
struct ResidueSlopes {
  MatrixXd jacobian, normal;
  VectorXd gradient;
};

ResidueSlopes slopes(const VectorXcd& s, int power, const ResidueFit& at, const VectorXd& left) {
  ResidueSlopes found;
  found.jacobian = jacobian(s, power, at);
  found.normal = found.jacobian.transpose() * found.jacobian;
  found.gradient = found.jacobian.transpose() * left;
  return found;
}

/// What H tends to as s grows [unit of H]: s^2 (R / (s - p) + c.c.) tends to 2 Re(R p) where Re R is 0.
VectorXd at_high_frequencies(const ResidueFit& at, int power) {
  if (power < 2) return VectorXd::Zero(at.lower.size());
  VectorXd sum = at.lower;
  for (std::size_t m = 0; m < at.rates.size(); ++m)
    sum += 2 * (at.residues.col(static_cast<Index>(m)) * at.rates[m]).real();
  return sum;
}

/// Errors of the responses (2 p F x q), as residual() stacks them, that those of the force make.
MatrixXd known_errors(const ResidueFit& at, int power, const ResponseNoise& noise) {
  const Index lines = at.reproduced.cols(), outputs = at.reproduced.rows();
  const VectorXd limit = at_high_frequencies(at, power);
  MatrixXd result(2 * outputs * lines, noise.force.cols() + noise.aliases.cols());
  for (Index o = 0; o < outputs; ++o) {
    MatrixXcd of_output(lines, result.cols());
    const VectorXcd h = at.reproduced.row(o).transpose();
    if (noise.force.cols() > 0) of_output.leftCols(noise.force.cols()) = -(h.asDiagonal() * noise.force);
    if (noise.aliases.cols() > 0)
      of_output.rightCols(noise.aliases.cols()) =
          VectorXcd(limit[o] - h.array()).asDiagonal() * noise.aliases;
    result.middleRows(2 * o * lines, 2 * lines) = stacked(of_output);
  }
  return result;
}

MatrixXd covariance_of_residues(const VectorXd& frequency_hz, int power, const ResidueFit& at,
                                const ResidueSlopes& slope, const VectorXd& left,
                                const ResponseNoise& noise) {
  const Index n = slope.normal.cols();
  if (left.size() <= n) throw std::runtime_error("fewer lines than parameters");
  const MatrixXd inverse = filters::solve_damped(slope.normal, 0, MatrixXd::Identity(n, n));
  const MatrixXd known = known_errors(at, power, noise),
                 moved = inverse * (slope.jacobian.transpose() * known);
  const Index force = noise.force.cols();  // aliases are known too roughly to be taken off
  const VectorXd explained =
      (known.leftCols(force) - slope.jacobian * moved.leftCols(force)).rowwise().squaredNorm();
  return covariance_under(noise.lines, frequency_hz, slope.jacobian, inverse, left, explained) +
         moved * moved.transpose();
}

}  // namespace

ResidueFit fit_residues(const VectorXd& frequency_hz, const MatrixXcd& responses, double shift, int power,
                        const std::vector<Complex>& rates) {
  return fit(points(frequency_hz, shift), responses, power, rates);
}

ResidueFit refine_poles(const VectorXd& frequency_hz, const MatrixXcd& responses, double shift, int power,
                        const std::vector<Complex>& rates, const ResponseNoise& noise) {
  const VectorXcd s = points(frequency_hz, shift);
  ResidueFit at = fit(s, responses, power, rates);
  VectorXd left = residual(responses, at);
  ResidueSlopes slope = slopes(s, power, at, left);
  const auto step = [&](double damping) -> VectorXd {
    return filters::solve_damped(slope.normal, damping, slope.gradient);
  };
  const auto take = [&](const VectorXd& tried) {
    std::vector<Complex> next = at.rates;
    double moved = 0;
    for (std::size_t m = 0; m < next.size(); ++m) {
      const auto place = static_cast<Index>(2 * m);
      next[m] += Complex(-tried[place + 1], tried[place]);
      moved = std::max(moved, std::abs(next[m] - at.rates[m]) / std::abs(next[m]));
    }
    if (moved < 1e-9) return filters::TriedStep{0.0, true};
    ResidueFit there = fit(s, responses, power, next);
    const VectorXd left_there = residual(responses, there);
    if (!(left_there.squaredNorm() <= left.squaredNorm() * (1 + 1e-12))) return filters::TriedStep{};
    at = std::move(there);
    left = left_there;
    slope = slopes(s, power, at, left);
    return filters::TriedStep{1.0, false};
  };
  if (filters::levenberg_marquardt({}, step, take) != filters::DescentEnd::settled)
    throw std::runtime_error("the fit of frequency responses does not converge");
  at.covariance = covariance_of_residues(frequency_hz, power, at, slope, left, noise);
  return at;
}

}  // namespace beamid::experiments
