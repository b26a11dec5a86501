#include "fem/solvers/refined_solver.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <Eigen/CholmodSupport>
#include <Eigen/UmfPackSupport>

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

namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr int most_corrections = 6;
constexpr double enough = 1e-13;      // energy of a correction's forces, relative, below which it is the last
constexpr double fast_enough = 1e-2;  // of each correction to the one before
constexpr double small_enough = 1e-9;  // of the one that ends a trial

// K with the rows and columns of held coordinates those of the unit matrix.
SparseMatrix held_stiffness(const StrainFactors& stiffness, const std::vector<bool>& held) {
  SparseMatrix k = stiffness.assembled();
  k.prune([&](Index row, Index column, double) {
    return row == column || (!held[static_cast<std::size_t>(row)] && !held[static_cast<std::size_t>(column)]);
  });
  for (Index i = 0; i < k.cols(); ++i)
    if (held[static_cast<std::size_t>(i)]) k.coeffRef(i, i) = 1.0;
  return k;
}

std::vector<bool> flags(Index coordinates, const std::vector<int>& held) {
  std::vector<bool> result(static_cast<std::size_t>(coordinates), false);
  for (const int coordinate : held) result[static_cast<std::size_t>(coordinate)] = true;
  return result;
}

}  // namespace

struct RefinedSolver::Factors {
  StrainFactors stiffness;
  SparseMatrix transposed;  // B^T, whose products go by rows
  std::vector<int> held;
  Eigen::CholmodSupernodalLLT<SparseMatrix> cholesky;
  bool serves = false;

  Factors(const StrainFactors& of, const std::vector<int>& kept_at_zero)
      : stiffness(of), transposed(of.strain.transpose()), held(kept_at_zero) {
    cholesky.cholmod().print = 0;
    cholesky.compute(held_stiffness(of, flags(of.strain.cols(), held)));
    if (cholesky.info() != Eigen::Success) return;
    const VectorXd load = VectorXd::LinSpaced(of.strain.cols(), 1.0, 2.0);
    VectorXd coordinates(load.size()), forces(of.strain.rows());
    serves = correct(load, coordinates, forces) < small_enough;
  }

  // Relative energy of the last correction; 1 where they do not become smaller fast.
  double correct(Eigen::Ref<const VectorXd> f, Eigen::Ref<VectorXd> coordinates,
                 Eigen::Ref<VectorXd> forces) const {
    coordinates.setZero();
    forces.setZero();
    double last = 1.0;
    for (int i = 0; i < most_corrections; ++i) {
      const VectorXd e = stiffness.flexibility * forces - stiffness.strain * coordinates;
      const VectorXd stress = stiffness.rigidity * e;
      VectorXd load = f - transposed * forces;
      load.noalias() += transposed * stress;
      for (const int coordinate : held) load[coordinate] = 0.0;
      const VectorXd more = cholesky.solve(load);
      const VectorXd strain = stiffness.strain * more - e, more_forces = stiffness.rigidity * strain;
      coordinates += more;
      forces += more_forces;
      if (i == 0) continue;
      const double all = forces.dot(stiffness.flexibility * forces), energy = more_forces.dot(strain);
      const double relative = all > 0.0 ? std::sqrt(std::abs(energy) / all) : 0.0;
      if (!(relative >= enough)) return std::isfinite(relative) ? relative : 1.0;
      if (!(relative < fast_enough * last)) return relative < small_enough ? relative : 1.0;
      last = relative;
    }
    return last;
  }
};

RefinedSolver::RefinedSolver(const StrainFactors& stiffness, const std::vector<int>& held)
    : factors_(std::make_unique<Factors>(stiffness, held)) {}
RefinedSolver::~RefinedSolver() = default;
RefinedSolver::RefinedSolver(RefinedSolver&&) noexcept = default;

bool RefinedSolver::serves() const {
  return factors_->serves;
}

void RefinedSolver::solve(Eigen::Ref<const VectorXd> f, Eigen::Ref<VectorXd> coordinates,
                          Eigen::Ref<VectorXd> natural_forces) const {
  factors_->correct(f, coordinates, natural_forces);
}

}  // namespace beamid::fem
