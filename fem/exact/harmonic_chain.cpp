#include "fem/exact/harmonic_chain.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace beamid::fem {
namespace {

using Eigen::Matrix2d, Eigen::Matrix4d, Eigen::Vector2d;
using Basis = Eigen::Matrix<double, 4, 2>;

int negative_eigenvalues(const Matrix2d& q) {
  const double off = 0.5 * (q(0, 1) + q(1, 0)), determinant = q(0, 0) * q(1, 1) - off * off;
  if (determinant < 0.0) return 1;
  return q.trace() < 0.0 ? (determinant > 0.0 ? 2 : 1) : 0;
}

// Y = Q R; returns R^-1, which maps coefficients of Q to those of Y.
Matrix2d orthonormalise(Basis& y) {
  const double first = y.col(0).norm();
  y.col(0) /= first;
  const double along = y.col(0).dot(y.col(1));
  y.col(1) -= along * y.col(0);
  const double second = y.col(1).norm();
  y.col(1) /= second;
  return Matrix2d{{1.0 / first, -along / (first * second)}, {0.0, 1.0 / second}};
}

// Of the states, those with component i zero, and any reaction there. Returns the map of coefficients.
Matrix2d hold(Basis& y, int i) {
  const double size = y.row(i).norm();
  if (size == 0.0) return Matrix2d::Identity();  // already so, reaction included
  const Vector2d still = Vector2d(-y(i, 1), y(i, 0)) / size;
  y.col(0) = (y * still).eval();
  y(i, 0) = 0.0;
  y.col(1) = HarmonicState::Unit(2 + i);
  Matrix2d map = Matrix2d::Zero();
  map.col(0) = still;
  return map;
}

Matrix2d dynamic_stiffness(const HarmonicNode& node, double omega, const StateScale& scale) {
  Matrix2d z = node.stiffness - omega * omega * node.mass;
  for (const auto& [mass, stiffness] : node.absorbers) {
    const double inertia = omega * omega * mass, margin = stiffness - inertia;
    z(0, 0) -= inertia * stiffness / (margin != 0.0 ? margin : std::numeric_limits<double>::min());
  }
  for (int i = 0; i < 2; ++i)  // what a support holds does not load the beam
    if (node.held[i]) z.row(i).setZero(), z.col(i).setZero();
  const double unit = scale.bending_stiffness / scale.length;
  z(0, 0) /= unit / (scale.length * scale.length);
  z(0, 1) /= unit / scale.length;
  z(1, 0) /= unit / scale.length;
  z(1, 1) /= unit;
  return z;
}

}  // namespace

struct HarmonicChain::Sweep {
  struct Step {
    double from = 0.0;                        // [m]
    Matrix4d rate = Matrix4d::Zero();         // A
    Basis basis = Basis::Zero();              // Y at its begin
    Matrix2d earlier = Matrix2d::Identity();  // from coefficients there to those of the step before
  };
  StateScale scale;
  int count = 0;
  std::vector<Step> steps;
  Matrix2d end = Matrix2d::Zero();     // what must vanish at the last node, per coefficient
  Matrix2d to_end = Matrix2d::Zero();  // from coefficients there to those of the last step
};

StateScale HarmonicChain::scale(double omega) const {
  double shortest = nodes.back().position - nodes.front().position, stiffness = 0.0;
  for (const UniformPiece& piece : pieces) {
    shortest = std::min(shortest, 1.0 / piece.wave_number(omega));
    stiffness = std::max(stiffness, piece.bending_stiffness);
  }
  return {shortest, stiffness};
}

HarmonicChain::Sweep HarmonicChain::sweep(double omega, bool keep) const {
  Sweep result;
  result.scale = scale(omega);
  Basis y = Basis::Identity();
  Matrix2d earlier = Matrix2d::Identity();
  const auto u = y.topRows<2>(), f = y.bottomRows<2>();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const HarmonicNode& node = nodes[i];
    y.bottomRows<2>() += dynamic_stiffness(node, omega, result.scale) * u;
    earlier *= orthonormalise(y);
    for (const auto& absorber : node.absorbers)
      if (omega * omega * absorber.mass > absorber.stiffness) ++result.count;
    if (i + 1 == nodes.size()) {
      for (int k = 0; k < 2; ++k) result.end.row(k) = y.row(node.held[k] ? k : 2 + k);
      result.to_end = earlier;
    }
    for (int k = 0; k < 2; ++k)
      if (node.held[k]) earlier *= hold(y, k);
    if (i + 1 == nodes.size()) break;

    const UniformPiece& piece = pieces[i];
    const double waves = piece.length * piece.wave_number(omega);
    constexpr double most_waves = 1e6;  // of a mode number that nobody asks for
    if (!(waves < most_waves))
      throw std::invalid_argument(
          "exact modes: the beam's length, stiffness, mass and springs lie too far apart for double "
          "precision; expected all of them in SI units");
    const int steps = std::max(1, static_cast<int>(std::ceil(waves)));
    const double step = piece.length / steps;
    const Matrix4d rate = piece.rate(omega, result.scale),
                   t = transition(rate * (step / result.scale.length));
    const Matrix2d near = t.topRightCorner<2, 2>().inverse() * t.topLeftCorner<2, 2>();
    for (int k = 0; k < steps; ++k) {
      result.count += negative_eigenvalues(u.transpose() * (f + near * u));
      if (keep) result.steps.push_back({node.position + k * step, rate, y, earlier});
      y = (t * y).eval();
      earlier = orthonormalise(y);
    }
  }
  result.count += negative_eigenvalues(u.transpose() * f);
  return result;
}

int HarmonicChain::count_below(double omega) const {
  return sweep(omega, false).count;
}

Eigen::VectorXd HarmonicChain::deflection(double omega, int which,
                                          const std::vector<double>& positions) const {
  const Sweep path = sweep(omega, true);
  const Eigen::JacobiSVD<Matrix2d> end(path.end, Eigen::ComputeFullV);
  Eigen::VectorXd w = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(positions.size()));
  if (end.singularValues()[1 - which] > 1e-6) return w;  // of order one where there is no mode
  Vector2d coefficients = path.to_end * end.matrixV().col(1 - which);
  std::vector<HarmonicState> begin(path.steps.size());
  double largest = 0.0;
  for (std::size_t k = path.steps.size(); k-- > 0;) {
    begin[k] = path.steps[k].basis * coefficients;
    coefficients = path.steps[k].earlier * coefficients;
    largest = std::max(largest, std::abs(begin[k][0]));
  }
  std::size_t k = 0;
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    while (k + 1 < begin.size() && path.steps[k + 1].from <= positions[i]) ++k;
    const double beyond = (positions[i] - path.steps[k].from) / path.scale.length;
    w[i] = advance(path.steps[k].rate * beyond, begin[k])[0] / largest;
  }
  return w;
}

}  // namespace beamid::fem
