#include "fem/solvers/mixed_solver.hpp"

#include <Eigen/UmfPackSupport>
#include <stdexcept>
#include <vector>

namespace beamid::fem {
namespace {

SparseMatrix mixed_matrix(const StrainFactors& stiffness, const std::vector<int>& held) {
  const auto strains = static_cast<int>(stiffness.strain.rows());
  const auto coordinates = static_cast<int>(stiffness.strain.cols());
  std::vector<bool> is_held(static_cast<std::size_t>(coordinates), false);
  for (const int coordinate : held) is_held[coordinate] = true;
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < stiffness.flexibility.outerSize(); ++k)
    for (SparseMatrix::InnerIterator it(stiffness.flexibility, k); it; ++it)
      entries.emplace_back(it.row(), it.col(), -it.value());
  for (int k = 0; k < stiffness.strain.outerSize(); ++k) {
    if (is_held[k]) {
      entries.emplace_back(strains + k, strains + k, 1.0);
      continue;
    }
    for (SparseMatrix::InnerIterator it(stiffness.strain, k); it; ++it) {
      entries.emplace_back(it.row(), strains + k, it.value());
      entries.emplace_back(strains + k, it.row(), it.value());
    }
  }
  SparseMatrix matrix(strains + coordinates, strains + coordinates);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

struct MixedSolver::Factorisation {
  Factorisation(const StrainFactors& stiffness, const std::vector<int>& held_coordinates)
      : matrix(mixed_matrix(stiffness, held_coordinates)), held(held_coordinates), lu(matrix) {}
  SparseMatrix matrix;  // UmfPackLU keeps a reference to it
  std::vector<int> held;
  Eigen::UmfPackLU<SparseMatrix> lu;
};

MixedSolver::MixedSolver(const StrainFactors& stiffness, const std::vector<int>& held)
    : factorisation_(std::make_unique<Factorisation>(stiffness, held)) {
  if (factorisation_->lu.info() != Eigen::Success)
    throw std::runtime_error("the stiffness is singular: the structure can move without strain, or buckles");
}
MixedSolver::~MixedSolver() = default;
MixedSolver::MixedSolver(MixedSolver&&) noexcept = default;

void MixedSolver::solve(Eigen::Ref<const Eigen::VectorXd> f, Eigen::Ref<Eigen::VectorXd> coordinates,
                        Eigen::Ref<Eigen::VectorXd> natural_forces) const {
  Eigen::VectorXd right = Eigen::VectorXd::Zero(factorisation_->matrix.rows());
  right.tail(f.size()) = f;
  for (const int coordinate : factorisation_->held) right[natural_forces.size() + coordinate] = 0.0;
  const Eigen::VectorXd solution = factorisation_->lu.solve(right);
  natural_forces = solution.head(natural_forces.size());
  coordinates = solution.tail(f.size());
}

}  // namespace beamid::fem
