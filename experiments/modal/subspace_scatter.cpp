#include "experiments/modal/subspace_scatter.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::MatrixXcd, Eigen::VectorXd, Eigen::VectorXcd;

constexpr double vanishing_pole_scatter = 1e-6;  // poles z that are over within a sample

/// W of dU_n = U_rest W.
MatrixXd turned(const ScatteredHankel& hankel, const MatrixXd& change, Index n) {
  const Index rest = hankel.left.cols() - n;
  const VectorXd& s = hankel.singular_values;
  MatrixXd turn(rest, n);
  for (Index i = 0; i < n; ++i)
    for (Index k = 0; k < rest; ++k)
      turn(k, i) = (s[i] * change(n + k, i) + s[n + k] * change(i, n + k)) /
                   std::max(s[i] * s[i] - s[n + k] * s[n + k], 1e-300);
  return turn;
}

/// The realisation of one order, and all that its derivatives need.
struct Realisation {
  Index p, n, shift;
  MatrixXd gram_inverse, inverse, remainder, rest;  ///< (O_up^T O_up)^-1, O_up^+, O_down - O_up A, U_rest
  MatrixXcd vectors, inverse_vectors;
  VectorXcd poles;
  MatrixXcd shapes;  ///< C phi (p x n)
};

Realisation realise(const ScatteredHankel& hankel, Index n) {
  Realisation r;
  const Index a = hankel.left.rows();
  r.p = hankel.outputs;
  r.n = n;
  r.shift = a - r.p;
  const MatrixXd subspace = hankel.left.leftCols(n);
  const MatrixXd up = subspace.topRows(r.shift), down = subspace.bottomRows(r.shift);
  r.gram_inverse = (up.transpose() * up).inverse();
  r.inverse = r.gram_inverse * up.transpose();
  const MatrixXd transition = r.inverse * down;
  r.remainder = down - up * transition;
  r.rest = hankel.left.rightCols(a - n);
  const Eigen::EigenSolver<MatrixXd> solver(transition);
  r.poles = solver.eigenvalues();
  r.vectors = solver.eigenvectors();
  r.inverse_vectors = r.vectors.inverse();
  r.shapes = subspace.topRows(r.p) * r.vectors;
  return r;
}

struct SubspaceChange {
  Complex pole;
  VectorXcd shape;
};

/// First-order change of pole i and its shape when U_n moves by U_rest turn.
SubspaceChange change_of(const Realisation& r, Index i, const MatrixXd& turn) {
  const VectorXcd vector = r.vectors.col(i);
  const VectorXcd moved = r.rest * (turn * vector);  // dU_n phi
  const VectorXcd left = r.rest.topRows(r.shift).transpose() * (r.remainder * vector);
  const VectorXcd transition = r.inverse * (moved.tail(r.shift) - r.poles[i] * moved.head(r.shift)) +
                               r.gram_inverse * (turn.transpose() * left);  // dA phi
  const VectorXcd parts = r.inverse_vectors * transition;
  SubspaceChange change{parts[i], moved.head(r.p)};
  for (Index m = 0; m < r.n; ++m)
    if (m != i) change.shape += r.shapes.col(m) * (parts[m] / (r.poles[i] - r.poles[m]));
  return change;
}

}  // namespace

std::vector<Pole> scattered_poles(const ScatteredHankel& hankel, int order, double interval) {
  const Realisation r = realise(hankel, order);
  std::vector<MatrixXd> turns;
  for (const MatrixXd& change : hankel.changes) turns.push_back(turned(hankel, change, order));
  std::vector<Pole> found;
  for (Index i = 0; i < r.n; ++i) {
    const Complex z = r.poles[i];
    if (!(z.imag() > 0 && std::abs(z) > vanishing_pole_scatter)) continue;
    Pole pole{std::log(z) / interval, r.shapes.col(i)};
    Index largest = 0;
    pole.shape.cwiseAbs().maxCoeff(&largest);
    const Complex scale = pole.shape[largest];
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
    VectorXd shape_variance = VectorXd::Zero(r.p);
    for (const MatrixXd& turn : turns) {
      const SubspaceChange change = change_of(r, i, turn);
      const Complex rate = change.pole / (z * interval);
      const Eigen::Vector2d both(rate.imag(), -rate.real());
      covariance += both * both.transpose();
      const VectorXcd scaled = pole.shape / scale,
                      moved = (change.shape - scaled * change.shape[largest]) / scale;
      for (Index c = 0; c < r.p; ++c)
        if (const double size = std::abs(scaled[c]); size > 0)
          shape_variance[c] += std::pow((std::conj(scaled[c]) * moved[c]).real() / size, 2);
    }
    pole.shape /= scale;
    if (!turns.empty()) {
      pole.take_deviations(covariance);
      pole.shape_deviation = shape_variance.cwiseSqrt();
    }
    found.push_back(std::move(pole));
  }
  std::sort(found.begin(), found.end(),
            [](const Pole& a, const Pole& b) { return std::abs(a.rate) < std::abs(b.rate); });
  return found;
}

}  // namespace beamid::experiments
