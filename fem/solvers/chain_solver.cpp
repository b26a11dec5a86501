#include "fem/solvers/chain_solver.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace beamid::fem {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

bool ChainSolver::suits(const StrainSweeps& sweeps) {
  constexpr std::size_t few = 40;
  const std::size_t constraints = sweeps.gauges().size() + sweeps.redundants().size();
  return constraints <= few && static_cast<Index>(constraints) <= sweeps.steps();
}

ChainSolver::ChainSolver(const StrainFactors& stiffness, StrainSweeps sweeps, const RigidMotions& rigid)
    : sweeps_(std::move(sweeps)),
      flexibility_(stiffness.flexibility),
      redundant_(selected_rows(stiffness.strain, sweeps_.redundants())),
      kept_(rigid.kept) {
  const Index redundants = redundant_.rows(), kept = static_cast<Index>(kept_.size());
  if (redundants == 0) return;
  MatrixXd system = MatrixXd::Zero(redundants + kept, redundants + kept);
  system.topRightCorner(redundants, kept) = -rigid.constraint;
  system.bottomLeftCorner(kept, redundants) = rigid.constraint.transpose();
  const VectorXd no_load = VectorXd::Zero(stiffness.strain.cols()), at_rest = VectorXd::Zero(kept);
  VectorXd coordinates(stiffness.strain.cols()), forces = VectorXd::Zero(stiffness.strain.rows());
  for (Index j = 0; j < redundants; ++j) {
    find_forces(no_load, VectorXd::Unit(redundants, j), coordinates, forces);
    find_coordinates(forces, at_rest, coordinates);
    system.col(j).head(redundants) = -gaps(coordinates, forces);
  }
  // Forces, moments over h and coordinates have their own units: make every row's largest entry about 1.
  scale_ = VectorXd::Ones(redundants + kept);
  for (int pass = 0; pass < 5; ++pass)
    for (Index i = 0; i < scale_.size(); ++i) {
      const double largest =
          (system.row(i).transpose().cwiseAbs().cwiseProduct(scale_)).maxCoeff() * scale_[i];
      if (largest > 0.0) scale_[i] /= std::sqrt(largest);
    }
  small_.compute(scale_.asDiagonal() * system * scale_.asDiagonal());
  if (!small_.isInvertible())
    throw std::runtime_error(
        "the stiffness is singular in double precision: the mesh is too fine for so many supports and loops, "
        "or an axial load buckles the structure");
  constexpr Index worth_keeping = 4;  // columns as long as the chain
  if (system.rows() > worth_keeping) return;
  MatrixXd unit_coordinates(coordinates.size(), system.rows()), unit_forces(forces.size(), system.rows());
  for (Index j = 0; j < system.rows(); ++j) {
    unit_coordinates.col(j).setZero();
    unit_forces.col(j).setZero();
    add_responses(VectorXd::Unit(system.rows(), j), unit_coordinates.col(j), unit_forces.col(j));
  }
  unit_coordinates_.swap(unit_coordinates);
  unit_forces_.swap(unit_forces);
}

// Natural forces that balance f together with the redundant ones; scratch keeps what the gauges do not
// balance.
void ChainSolver::find_forces(Eigen::Ref<const VectorXd> f, const VectorXd& redundant_forces,
                              Eigen::Ref<VectorXd> scratch, Eigen::Ref<VectorXd> natural_forces) const {
  scratch = f;
  for (Index i = 0; i < redundant_forces.size(); ++i) {
    natural_forces[sweeps_.redundants()[i]] = redundant_forces[i];
    if (redundant_forces[i] == 0.0) continue;
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(redundant_, i); it; ++it)
      scratch[it.col()] -= it.value() * redundant_forces[i];
  }
  sweeps_.sweep_backward(scratch.data(), natural_forces.data());
}

void ChainSolver::find_coordinates(const Eigen::Ref<const VectorXd>& natural_forces,
                                   const VectorXd& kept_values, Eigen::Ref<VectorXd> coordinates) const {
  for (const int gauge : sweeps_.gauges()) coordinates[gauge] = 0.0;
  for (Index i = 0; i < kept_values.size(); ++i) coordinates[kept_[i]] = kept_values[i];
  const double* const forces = natural_forces.data();
  sweeps_.sweep_forward([&](int row) { return flexibility_.product(row, forces + row); }, coordinates.data());
}

// R q - (F N)_r
VectorXd ChainSolver::gaps(const Eigen::Ref<const VectorXd>& coordinates,
                           const Eigen::Ref<const VectorXd>& natural_forces) const {
  VectorXd result = redundant_ * coordinates;
  for (Index i = 0; i < result.size(); ++i) {
    const int row = sweeps_.redundants()[i];
    result[i] -= flexibility_.product(row, natural_forces.data() + row);
  }
  return result;
}

VectorXd ChainSolver::unknowns(const VectorXd& right) const {
  return scale_.cwiseProduct(small_.solve(scale_.cwiseProduct(right)));
}

void ChainSolver::add_responses(const VectorXd& unknowns, Eigen::Ref<VectorXd> coordinates,
                                Eigen::Ref<VectorXd> natural_forces) const {
  if (unit_coordinates_.cols() > 0) {
    coordinates.noalias() += unit_coordinates_ * unknowns;
    natural_forces.noalias() += unit_forces_ * unknowns;
    return;
  }
  VectorXd more_coordinates(coordinates.size()), more_forces = VectorXd::Zero(natural_forces.size());
  find_forces(VectorXd::Zero(coordinates.size()), unknowns.head(redundant_.rows()), more_coordinates,
              more_forces);
  find_coordinates(more_forces, unknowns.tail(static_cast<Index>(kept_.size())), more_coordinates);
  coordinates += more_coordinates;
  natural_forces += more_forces;
}

void ChainSolver::solve(Eigen::Ref<const VectorXd> f, Eigen::Ref<VectorXd> coordinates,
                        Eigen::Ref<VectorXd> natural_forces) const {
  const Index redundants = redundant_.rows(), kept = static_cast<Index>(kept_.size());
  find_forces(f, VectorXd::Zero(redundants), coordinates, natural_forces);
  VectorXd right(redundants + kept);
  for (Index i = 0; i < kept; ++i) right[redundants + i] = coordinates[kept_[i]];
  find_coordinates(natural_forces, VectorXd::Zero(kept), coordinates);
  if (redundants == 0) return;
  right.head(redundants) = gaps(coordinates, natural_forces);
  add_responses(unknowns(right), coordinates, natural_forces);
}

void ChainSolver::solve_carefully(Eigen::Ref<const VectorXd> f, Eigen::Ref<VectorXd> coordinates,
                                  Eigen::Ref<VectorXd> natural_forces) const {
  const Index redundants = redundant_.rows(), kept = static_cast<Index>(kept_.size());
  solve(f, coordinates, natural_forces);
  if (redundants > 0) {
    VectorXd known_forces(redundants), known_gauges(kept);
    for (Index i = 0; i < redundants; ++i) known_forces[i] = natural_forces[sweeps_.redundants()[i]];
    for (Index i = 0; i < kept; ++i) known_gauges[i] = coordinates[kept_[i]];
    find_forces(f, known_forces, coordinates, natural_forces);
    for (const int gauge : sweeps_.gauges()) coordinates[gauge] = 0.0;
    for (Index i = 0; i < kept; ++i) coordinates[kept_[i]] = known_gauges[i];
  }
  VectorXd low = VectorXd::Zero(coordinates.size());
  const double* const forces = natural_forces.data();
  sweeps_.sweep_forward_compensated([&](int row) { return flexibility_.product(row, forces + row); },
                                    coordinates.data(), low.data());
  if (redundants == 0) return;
  VectorXd right = VectorXd::Zero(redundants + kept);
  right.head(redundants) = gaps(coordinates, natural_forces);
  coordinates += low;
  add_responses(unknowns(right), coordinates, natural_forces);
}

}  // namespace beamid::fem
