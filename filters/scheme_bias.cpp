#include "filters/scheme_bias.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// x' = A x, no unknowns: what a scheme is run on to obtain its matrix.
class FixedMotion final : public LinearMotion {
 public:
  explicit FixedMotion(MatrixXd matrix) : matrix_(std::move(matrix)) {}

  Index motion_size() const override { return matrix_.rows(); }
  Index parameter_size() const override { return 0; }
  void motion_matrix(const VectorXd&, MatrixXd& matrix) const override { matrix = matrix_; }
  void motion_matrix_derivative(const VectorXd&, Index, MatrixXd& matrix) const override {
    matrix.setZero(matrix_.rows(), matrix_.rows());
  }
  std::vector<Label> state_labels() const override {
    return std::vector<Label>(static_cast<std::size_t>(matrix_.rows()), Label{"x", "1"});
  }
  std::vector<Label> output_labels() const override { return state_labels(); }
  void output(const VectorXd& state, const VectorXd&, VectorXd& output) const override { output = state; }

 private:
  MatrixXd matrix_;
};

MatrixXd stepped(Scheme& scheme, const MatrixXd& z, Index first_column) {
  const FixedMotion motion(z);
  const VectorXd no_input;
  MatrixXd moved(z.rows(), z.rows() - first_column);
  VectorXd next;
  for (Index j = 0; j < moved.cols(); ++j) {
    scheme.step(motion, VectorXd::Unit(z.rows(), first_column + j), no_input, 1.0, next, nullptr);
    moved.col(j) = next;
  }
  return moved;
}

/// [Z, D; 0, Z], whose function is [g(Z), slope along D; 0, g(Z)].
MatrixXd beside(const MatrixXd& z, const MatrixXd& direction) {
  const Index n = z.rows();
  MatrixXd pair = MatrixXd::Zero(2 * n, 2 * n);
  pair.topLeftCorner(n, n) = pair.bottomRightCorner(n, n) = z;
  pair.topRightCorner(n, n) = direction;
  return pair;
}

bool is_exact(const Scheme& scheme) {
  const std::complex<double> z(-0.3, 0.7);
  return scheme.amplification(z).value == std::exp(z);
}

/// Rates are divided by the highest frequency, so that both halves of a state are of one size.
double frequency_scale(const SecondOrder& of) {
  const MatrixXd turned = of.mass.ldlt().solve(of.stiffness);
  return std::sqrt(std::max(turned.cwiseAbs().rowwise().sum().maxCoeff(), 1e-300));
}

MatrixXd scaled_motion_matrix(const SecondOrder& of, double scale) {
  const Index n = of.size();
  MatrixXd a = of.motion_matrix();
  a.topRightCorner(n, n) *= scale;
  a.bottomLeftCorner(n, n) /= scale;
  return a;
}

/// -M^-1 K and -M^-1 C of the displacements that [x; y]' = A [x; y] has, whatever y is.
SecondOrder of_displacements(const MatrixXd& mass, const MatrixXd& a) {
  const Index n = mass.rows();
  MatrixXd to_rates = MatrixXd::Identity(2 * n, 2 * n);
  to_rates.bottomRows(n) = a.topRows(n);
  const Eigen::FullPivLU<MatrixXd> lu(to_rates);
  if (!lu.isInvertible())
    throw std::runtime_error("no equation of second order has these displacements: the step is too long");
  const MatrixXd rows = to_rates.bottomRows(n) * a * lu.inverse();
  return {mass, -mass * rows.rightCols(n), -mass * rows.leftCols(n)};
}

}  // namespace

MatrixXd SecondOrder::motion_matrix() const {
  const Index n = size();
  const Eigen::LDLT<MatrixXd> solver(mass);
  MatrixXd a = MatrixXd::Zero(2 * n, 2 * n);
  a.topRightCorner(n, n).setIdentity();
  a.bottomLeftCorner(n, n) = -solver.solve(stiffness);
  a.bottomRightCorner(n, n) = -solver.solve(damping);
  return a;
}

MatrixXd amplification(Scheme& scheme, const MatrixXd& z) {
  return is_exact(scheme) ? MatrixXd(z.exp()) : stepped(scheme, z, 0);
}

MatrixXd amplification_slope(Scheme& scheme, const MatrixXd& z, const MatrixXd& direction) {
  const Index n = z.rows();
  const MatrixXd pair = beside(z, direction);
  return is_exact(scheme) ? MatrixXd(MatrixXd(pair.exp()).topRightCorner(n, n))
                          : MatrixXd(stepped(scheme, pair, n).topRows(n));
}

MatrixXd seen_through(Scheme& scheme, const MatrixXd& matrix, double dt) {
  if (is_exact(scheme)) return matrix;
  const Index n = matrix.rows();
  const MatrixXd target = (matrix * dt).exp();
  const MatrixXd identity = MatrixXd::Identity(n, n);
  MatrixXd z = matrix * dt;
  double last = std::numeric_limits<double>::infinity();
  constexpr double rounding = 1e-15, settled = 1e-9;
  for (int iteration = 0; iteration < 50; ++iteration) {
    const MatrixXd moved = stepped(scheme, beside(z, identity), n);  // [g'(Z); g(Z)]
    const MatrixXd change = moved.topRows(n).partialPivLu().solve(moved.bottomRows(n) - target);
    const double size = change.norm() / std::max(z.norm(), 1e-300);
    if (!std::isfinite(size)) break;
    if (size <= settled && size >= 0.5 * last) return z / dt;  // rounding is all that changes
    z -= change;
    if (size <= rounding) return z / dt;
    last = size;
  }
  throw std::runtime_error(
      "no step of this discretisation reproduces the motion: the interval is too long for it");
}

std::vector<double> bias_series(const Scheme& scheme, int count) {
  // Cauchy's coefficients on a circle inside which no scheme's inverse has a branch point.
  constexpr int points = 32;
  constexpr double radius = 0.25, zero = 1e-10;
  std::vector<std::complex<double>> sums(static_cast<std::size_t>(count), 0.0);
  for (int k = 0; k < points; ++k) {
    const std::complex<double> z = std::polar(radius, 2.0 * std::numbers::pi * (k + 0.5) / points),
                               ratio = seen_through(scheme, z, 1.0) / z;
    for (int j = 0; j < count; ++j) sums[static_cast<std::size_t>(j)] += ratio / std::pow(z, j + 1);
  }
  std::vector<double> series;
  for (const std::complex<double> sum : sums) {
    const double value = sum.real() / points;
    series.push_back(std::abs(value) < zero ? 0.0 : value);
  }
  return series;
}

SecondOrder seen_through(Scheme& scheme, const SecondOrder& truth, double dt) {
  if (is_exact(scheme)) return truth;
  const double scale = frequency_scale(truth);
  const MatrixXd a = seen_through(scheme, scaled_motion_matrix(truth, scale), dt);
  return of_displacements(truth.mass, a);
}

SecondOrder behind(Scheme& scheme, const SecondOrder& found, double dt) {
  if (is_exact(scheme)) return found;
  const double scale = frequency_scale(found);
  const MatrixXd moved = amplification(scheme, scaled_motion_matrix(found, scale) * dt);
  return of_displacements(found.mass, moved.log() / dt);
}

BiasTerms first_terms(const Scheme& scheme, const SecondOrder& truth, double dt) {
  constexpr int highest = 8;
  const std::vector<double> series = bias_series(scheme, highest);
  const Index n = truth.size();
  BiasTerms terms{0, MatrixXd::Zero(n, n), MatrixXd::Zero(n, n)};
  const auto first = std::find_if(series.begin(), series.end(), [](double a) { return a != 0.0; });
  if (first == series.end()) return terms;
  terms.order = static_cast<int>(first - series.begin()) + 1;

  const Eigen::LDLT<MatrixXd> solver(truth.mass);
  const MatrixXd s = solver.solve(truth.stiffness), d = solver.solve(truth.damping);
  std::vector<MatrixXd> p{MatrixXd::Identity(n, n)}, q{MatrixXd::Zero(n, n)};
  for (int k = 0; k < 2 * terms.order + 1; ++k) {
    p.push_back(-q.back() * s);
    q.push_back(p[p.size() - 2] - q.back() * d);
  }
  for (int k = terms.order; k < 2 * terms.order; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const double factor = -series[at - 1] * std::pow(dt, k);
    terms.stiffness += factor * (2.0 * p[at + 2] + d * p[at + 1]);
    terms.damping += factor * (2.0 * q[at + 2] + d * q[at + 1]);
  }
  terms.stiffness = truth.mass * terms.stiffness;
  terms.damping = truth.mass * terms.damping;
  return terms;
}

}  // namespace beamid::filters
