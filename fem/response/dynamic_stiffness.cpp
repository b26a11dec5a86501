#include "fem/response/dynamic_stiffness.hpp"

#include <Eigen/UmfPackSupport>
#include <vector>

namespace beamid::fem {

using Eigen::Index, Eigen::MatrixXcd;
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

}  // namespace beamid::fem
