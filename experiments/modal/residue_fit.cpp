#include "experiments/modal/residue_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/signal/least_squares.hpp"
#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::MatrixXcd, Eigen::VectorXd, Eigen::VectorXcd;

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
