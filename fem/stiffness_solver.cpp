#include "fem/stiffness_solver.hpp"

#include <Eigen/UmfPackSupport>
#include <stdexcept>
#include <vector>

namespace beamid::fem {
namespace {

SparseMatrix mixed_matrix(const StrainFactors& stiffness) {
  const auto strains = static_cast<int>(stiffness.strain.rows());
  const auto coordinates = static_cast<int>(stiffness.strain.cols());
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < stiffness.flexibility.outerSize(); ++k)
    for (SparseMatrix::InnerIterator it(stiffness.flexibility, k); it; ++it)
      entries.emplace_back(it.row(), it.col(), -it.value());
  for (int k = 0; k < stiffness.strain.outerSize(); ++k)
    for (SparseMatrix::InnerIterator it(stiffness.strain, k); it; ++it) {
      entries.emplace_back(it.row(), strains + it.col(), it.value());
      entries.emplace_back(strains + it.col(), it.row(), it.value());
    }
  SparseMatrix matrix(strains + coordinates, strains + coordinates);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

struct StiffnessSolver::Factorisation {
  explicit Factorisation(const StrainFactors& stiffness) : matrix(mixed_matrix(stiffness)), lu(matrix) {}
  SparseMatrix matrix;  // UmfPackLU keeps a reference to it
  Eigen::UmfPackLU<SparseMatrix> lu;
};

StiffnessSolver::StiffnessSolver(const StrainFactors& stiffness)
    : factorisation_(std::make_unique<Factorisation>(stiffness)) {
  if (factorisation_->lu.info() != Eigen::Success)
    throw std::runtime_error("the stiffness is singular: the structure can move without strain");
}
StiffnessSolver::~StiffnessSolver() = default;
StiffnessSolver::StiffnessSolver(StiffnessSolver&&) noexcept = default;

Eigen::MatrixXd StiffnessSolver::solve(const Eigen::Ref<const Eigen::MatrixXd>& f) const {
  const Eigen::Index unknowns = factorisation_->matrix.rows();
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(unknowns, f.cols());
  right.bottomRows(f.rows()) = f;
  const Eigen::MatrixXd solution = factorisation_->lu.solve(right);
  return solution.bottomRows(f.rows());
}

Eigen::VectorXd static_shape(const StructuralSystem& system, Eigen::Index input, Eigen::Index output) {
  const Eigen::MatrixXd force = system.inputs.col(input);
  const Eigen::VectorXd q = StiffnessSolver(system.stiffness).solve(force);
  return q / (system.outputs * q)[output];
}

double static_stiffness(const StructuralSystem& system, Eigen::Index input, Eigen::Index output) {
  const Eigen::MatrixXd force = system.inputs.col(input);
  const Eigen::VectorXd q = StiffnessSolver(system.stiffness).solve(force);
  return 1.0 / (system.outputs * q)[output];
}

}  // namespace beamid::fem
