#include "fem/response/dynamic_stiffness.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/UmfPackSupport>

namespace beamid::fem {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd;
using Complex = std::complex<double>;

struct DynamicStiffness::Factorisation {
  Index strains = 0;
  Eigen::VectorXd flexibility, strain, mass, damping;  // entries of each part, in the pattern of the whole
  Eigen::SparseMatrix<Complex> matrix;                 // UmfPackLU keeps a reference to it
  Eigen::UmfPackLU<Eigen::SparseMatrix<Complex>> lu;
};

namespace {

// A part of the mixed matrix, as large as the whole.
SparseMatrix placed(const SparseMatrix& part, Index size, Index row, Index column,
                    bool and_transpose = false) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index k = 0; k < part.outerSize(); ++k)
    for (SparseMatrix::InnerIterator it(part, k); it; ++it) {
      const auto i = static_cast<int>(row + it.row()), j = static_cast<int>(column + it.col());
      entries.emplace_back(i, j, it.value());
      if (and_transpose) entries.emplace_back(j, i, it.value());
    }
  SparseMatrix whole(size, size);
  whole.setFromTriplets(entries.begin(), entries.end());
  return whole;
}

}  // namespace

DynamicStiffness::DynamicStiffness(const StructuralSystem& system)
    : factorisation_(std::make_unique<Factorisation>()) {
  Factorisation& f = *factorisation_;
  f.strains = system.stiffness.strain.rows();
  const Index size = f.strains + system.size();
  const SparseMatrix flexibility = placed(system.stiffness.flexibility, size, 0, 0);
  const SparseMatrix strain = placed(system.stiffness.strain, size, 0, f.strains, true);
  const SparseMatrix mass = placed(system.mass, size, f.strains, f.strains);
  const SparseMatrix damping = placed(system.damping, size, f.strains, f.strains);
  SparseMatrix pattern = flexibility + strain + mass + damping;
  pattern.makeCompressed();
  pattern.coeffs().setZero();
  const auto entries = [&](const SparseMatrix& part) {
    SparseMatrix whole = pattern + part;
    whole.makeCompressed();
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(whole.valuePtr(), whole.nonZeros()));
  };
  f.flexibility = entries(flexibility);
  f.strain = entries(strain);
  f.mass = entries(mass);
  f.damping = entries(damping);
  f.matrix = pattern.cast<Complex>();
  f.matrix.makeCompressed();
  // The symmetric strategy that UMFPACK would take wants pivots on the diagonal, rejects them for their size,
  // and fills the matrix: 400 times slower at 1000 elements.
  f.lu.umfpackControl()[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_UNSYMMETRIC;
}
DynamicStiffness::~DynamicStiffness() = default;

bool DynamicStiffness::factor(Complex stiffness, Complex mass, Complex damping) {
  Factorisation& f = *factorisation_;
  const bool is_first = f.lu.rows() == 0;
  f.matrix.coeffs() =
      f.strain.cast<Complex>() - f.flexibility / stiffness + mass * f.mass + damping * f.damping;
  if (is_first) f.lu.analyzePattern(f.matrix);
  f.lu.factorize(f.matrix);
  return f.lu.info() == Eigen::Success;
}

DynamicStiffness::Solution DynamicStiffness::solve(const MatrixXcd& force) const {
  const Factorisation& f = *factorisation_;
  MatrixXcd right = MatrixXcd::Zero(f.matrix.rows(), force.cols());
  right.bottomRows(force.rows()) = force;
  const MatrixXcd solution = f.lu.solve(right);
  return {solution.bottomRows(force.rows()), solution.topRows(f.strains)};
}

namespace {

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
