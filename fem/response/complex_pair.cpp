#include "fem/response/complex_pair.hpp"

#include <cmath>
#include <utility>

namespace beamid::fem {
namespace {

using Eigen::MatrixXd, Eigen::VectorXcd;
using Complex = std::complex<double>;

double mass_norm(const StructuralSystem& system, const VectorXcd& x) {
  return std::sqrt(x.dot(system.mass * x).real());
}

Complex square(const SparseMatrix& a, const VectorXcd& x) {
  return (x.transpose() * (a * x)).value();
}

// The root of m l^2 + c l + k = 0 next to `guess`. The one that does not cancel gives the other by their
// product.
Complex nearest_root(Complex m, Complex c, Complex k, Complex guess) {
  const Complex root = std::sqrt(c * c - 4.0 * m * k);
  const Complex far = -(std::abs(c + root) > std::abs(c - root) ? c + root : c - root) / (2.0 * m),
                near = k / (m * far);
  return std::abs(far - guess) < std::abs(near - guess) ? far : near;
}

}  // namespace

double ComplexRefinement::residual(Complex lambda, const VectorXcd& shape) const {
  const VectorXcd force = lambda * (lambda * (system_.mass * shape) + system_.damping * shape);
  MatrixXd parts(force.size(), 2);
  parts << force.real(), force.imag();
  const MatrixXd moved = solver_.solve(parts);
  return mass_norm(system_, shape + moved.col(0) + Complex(0.0, 1.0) * moved.col(1)) /
         mass_norm(system_, shape);
}

bool ComplexRefinement::improve(ComplexPair& pair) {
  const Complex lambda = pair.lambda;
  if (!dynamic_.factor(1.0, lambda * lambda, lambda)) return false;  // lambda is exact already
  const VectorXcd force = 2.0 * lambda * (system_.mass * pair.shape) + system_.damping * pair.shape;
  const auto [coordinates, natural_forces] = dynamic_.solve(force);
  const double norm = mass_norm(system_, coordinates.col(0));
  if (!(norm > 0.0 && std::isfinite(norm))) return false;
  ComplexPair better;
  better.shape = coordinates.col(0) / norm;
  const VectorXcd natural = natural_forces.col(0) / norm;
  better.lambda = nearest_root(square(system_.mass, better.shape), square(system_.damping, better.shape),
                               square(system_.stiffness.flexibility, natural), lambda);
  better.residual = residual(better.lambda, better.shape);
  const bool is_another_mode = std::abs(better.lambda - lambda) > 1e-3 * std::abs(lambda);
  if (is_another_mode || !(better.residual < pair.residual)) return false;
  pair = std::move(better);
  return true;
}

void ComplexRefinement::refine(ComplexPair& pair) {
  pair.shape /= mass_norm(system_, pair.shape);
  pair.residual = residual(pair.lambda, pair.shape);
  for (int step = 0; step < 3 && pair.residual > 1e-13; ++step)
    if (!improve(pair)) return;
}

}  // namespace beamid::fem
