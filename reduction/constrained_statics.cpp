#include "reduction/constrained_statics.hpp"

#include <Eigen/QR>
#include <Eigen/SparseLU>
#include <stdexcept>

#include "fem/stiffness_solver.hpp"
#include "fem/triplets.hpp"

namespace beamid::reduction {

using Eigen::Index, Eigen::MatrixXd;

namespace {

void place(const fem::SparseMatrix& part, Index row, Index column, double factor, bool and_transpose,
           fem::Triplets& entries) {
  for (int k = 0; k < part.outerSize(); ++k)
    for (fem::SparseMatrix::InnerIterator it(part, k); it; ++it) {
      const auto i = static_cast<int>(row + it.row()), j = static_cast<int>(column + it.col());
      entries.emplace_back(i, j, factor * it.value());
      if (and_transpose) entries.emplace_back(j, i, factor * it.value());
    }
}

// The constraints must tell the rigid-body motions apart.
void require_hold(const fem::StructuralSystem& system, const fem::SparseMatrix& constraints,
                  const std::string& owner) {
  const MatrixXd motions = fem::StiffnessSolver(system.stiffness).rigid_motions();
  if (motions.cols() == 0) return;
  const MatrixXd moved = constraints * motions;
  Eigen::ColPivHouseholderQR<MatrixXd> qr(moved);
  qr.setThreshold(1e-9);
  if (qr.rank() < motions.cols())
    throw std::invalid_argument(owner + ": the structure can move without strain in " +
                                std::to_string(motions.cols()) + " ways, and the " +
                                std::to_string(constraints.rows()) +
                                " points given do not hold them all; expected more points");
}

}  // namespace

struct ConstrainedStatics::Factorisation {
  Index strains = 0, coordinates = 0, constraints = 0;
  double scale = 1.0;  // N is solved for in units of 1 / scale, which makes the entries of D^-1 one at most
  fem::SparseMatrix matrix;
  Eigen::SparseLU<fem::SparseMatrix> lu;
};

ConstrainedStatics::ConstrainedStatics(const fem::StructuralSystem& system,
                                       const fem::SparseMatrix& constraints, const std::string& owner)
    : factorisation_(std::make_unique<Factorisation>()) {
  require_hold(system, constraints, owner);
  Factorisation& f = *factorisation_;
  f.strains = system.stiffness.strain.rows();
  f.coordinates = system.size();
  f.constraints = constraints.rows();
  f.scale = system.stiffness.flexibility.coeffs().cwiseAbs().maxCoeff();
  fem::Triplets entries;
  place(system.stiffness.flexibility, 0, 0, -1.0 / f.scale, false, entries);
  place(system.stiffness.strain, 0, f.strains, 1.0, true, entries);
  place(constraints, f.strains + f.coordinates, f.strains, 1.0, true, entries);
  const Index size = f.strains + f.coordinates + f.constraints;
  f.matrix = fem::sparse(size, size, entries);
  f.lu.compute(f.matrix);

  const std::string singular =
      owner + ": the mesh cannot follow so many points, or a load buckles the structure that they hold";
  if (f.lu.info() != Eigen::Success) throw std::invalid_argument(singular);
  MatrixXd right = MatrixXd::Zero(size, f.constraints);
  right.bottomRows(f.constraints).setIdentity();
  unit_shapes_ = solve(right);
  const MatrixXd gap = constraints * unit_shapes_ - MatrixXd::Identity(f.constraints, f.constraints);
  if (!(gap.cwiseAbs().maxCoeff() < 1e-8)) throw std::invalid_argument(singular);
}
ConstrainedStatics::~ConstrainedStatics() = default;

// With one round of refinement.
MatrixXd ConstrainedStatics::solve(const MatrixXd& right) const {
  const Factorisation& f = *factorisation_;
  MatrixXd solution = f.lu.solve(right);
  solution += f.lu.solve(MatrixXd(right - f.matrix * solution));
  return solution.middleRows(f.strains, f.coordinates);
}

MatrixXd ConstrainedStatics::deflection_under(const MatrixXd& loads) const {
  const Factorisation& f = *factorisation_;
  MatrixXd right = MatrixXd::Zero(f.matrix.rows(), loads.cols());
  right.middleRows(f.strains, f.coordinates) = f.scale * loads;
  return solve(right);
}

fem::SparseMatrix unit_rows(const std::vector<int>& coordinates, Index size) {
  fem::Triplets entries;
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    entries.emplace_back(static_cast<int>(i), coordinates[i], 1.0);
  return fem::sparse(static_cast<Index>(coordinates.size()), size, entries);
}

}  // namespace beamid::reduction
