#include "fem/stiffness_solver.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Core>
#include <Eigen/LU>

#include "fem/solvers/refined_solver.hpp"
#include "fem/solvers/strain_sweeps.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {

// Static solutions of a chain by sweeps along it.

/// The force method [argyris1979] on the sweeps of strain_sweeps.hpp. With F = D^-1, redundant forces N_r and
/// kept gauges q_k, equilibrium and compatibility are
///
///     N_d = B_d^-T (f_d - R_d^T N_r),     q_d = B_d^-1 ((F N)_d - B_k q_k)
///
/// and what remains is one equation per redundant, which closes its gap, and one per kept gauge, which
/// balances it:
///
///     [ X^T F X  -W ] [ N_r ]   [ R q - (F N)_r ]
///     [   W^T     0 ] [ q_k ] = [ f_k - B_k^T N ]     (right: at N_r = 0, q_k = 0)
///
/// X being the self-equilibrated natural forces of unit redundants. A solve takes a sweep each way, two where
/// anything is redundant.
class ChainSolver {
 public:
  /// Whether gauges and redundants are so few that the sweeps are worth it.
  static bool suits(const StrainSweeps& sweeps);

  ChainSolver(const StrainFactors& stiffness, StrainSweeps sweeps, const RigidMotions& rigid);

  /// q (n) and N (s) of the load f (n).
  void solve(Eigen::Ref<const Eigen::VectorXd> f, Eigen::Ref<Eigen::VectorXd> coordinates,
             Eigen::Ref<Eigen::VectorXd> natural_forces) const;

  /// The same to the last digits, at twice the time: forces are swept again with the redundants known, sums
  /// carry their rounding errors, and a second round of the small system closes the gaps that the first has
  /// left.
  void solve_carefully(Eigen::Ref<const Eigen::VectorXd> f, Eigen::Ref<Eigen::VectorXd> coordinates,
                       Eigen::Ref<Eigen::VectorXd> natural_forces) const;

 private:
  StrainSweeps sweeps_;
  RepeatedRows flexibility_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> redundant_;  // R
  std::vector<int> kept_;
  Eigen::VectorXd scale_;  // of the small system's rows and columns
  Eigen::FullPivLU<Eigen::MatrixXd> small_;

  Eigen::MatrixXd unit_coordinates_, unit_forces_;  // per unknown of the small system; empty where too many

  void find_forces(Eigen::Ref<const Eigen::VectorXd> f, const Eigen::VectorXd& redundant_forces,
                   Eigen::Ref<Eigen::VectorXd> scratch, Eigen::Ref<Eigen::VectorXd> natural_forces) const;
  void find_coordinates(const Eigen::Ref<const Eigen::VectorXd>& natural_forces,
                        const Eigen::VectorXd& kept_values, Eigen::Ref<Eigen::VectorXd> coordinates) const;
  Eigen::VectorXd gaps(const Eigen::Ref<const Eigen::VectorXd>& coordinates,
                       const Eigen::Ref<const Eigen::VectorXd>& natural_forces) const;
  Eigen::VectorXd unknowns(const Eigen::VectorXd& right) const;
  void add_responses(const Eigen::VectorXd& unknowns, Eigen::Ref<Eigen::VectorXd> coordinates,
                     Eigen::Ref<Eigen::VectorXd> natural_forces) const;
};

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

constexpr double balanced = 1e-8;  // work of a load in a rigid motion, relative to its terms

// Beyond this many gauges the strains are those of no chain, and LU is left to find out whether they hold it.
constexpr std::size_t most_gauges = 40;
constexpr Index worth_refining = 2000;  // coordinates; of fewer the mixed solver is as fast
constexpr double no_strain = 1e-13;     // of a solution, relative to the terms that cancel in it

VectorXd response(const StructuralSystem& system, Index input) {
  const StiffnessSolver solver(system.stiffness);
  if (const Index rigid = solver.rigid_motions().cols(); rigid > 0)
    throw std::runtime_error("the structure can move without strain: " + std::to_string(rigid) +
                             (rigid == 1 ? " rigid-body motion" : " rigid-body motions"));
  const MatrixXd force = system.inputs.col(input);
  return solver.solve(force);
}

struct StiffnessSolver::Method {
  Index coordinates, strains;
  RigidMotions rigid;
  std::optional<ChainSolver> chain;
  std::optional<RefinedSolver> refined;
  std::optional<MixedSolver> mixed;

  explicit Method(const StrainFactors& stiffness)
      : coordinates(stiffness.strain.cols()), strains(stiffness.strain.rows()) {
    StrainSweeps sweeps(stiffness.strain);
    const bool sweeps_left_open = sweeps.gauges().size() > most_gauges;
    if (!sweeps_left_open)
      rigid = fem::rigid_motions(sweeps, stiffness.strain);
    else
      rigid.motions.resize(coordinates, 0);
    if (ChainSolver::suits(sweeps))
      chain.emplace(stiffness, std::move(sweeps), rigid);
    else
      factor(stiffness);
    if (sweeps_left_open) refuse_motion_without_strain(stiffness);
  }

  void factor(const StrainFactors& stiffness) {
    if (coordinates >= worth_refining && stiffness.rigidity.diagonal().minCoeff() > 0.0) {
      refined.emplace(stiffness, rigid.held);
      if (refined->serves()) return;
      refined.reset();
    }
    mixed.emplace(stiffness, rigid.held);
  }

  // Factors meet a rigid-body motion as a pivot that rounding has left: its solutions are then nearly all
  // that motion.
  void refuse_motion_without_strain(const StrainFactors& stiffness) const {
    const VectorXd load = VectorXd::LinSpaced(coordinates, 1.0, 2.0);
    VectorXd motion(coordinates), forces(strains);
    solve(load, motion, forces);
    const VectorXd strain = stiffness.strain * motion,
                   terms = stiffness.strain.cwiseAbs() * motion.cwiseAbs();
    if (!(strain.cwiseAbs().maxCoeff() > no_strain * terms.maxCoeff()))
      throw std::runtime_error("the structure can move without strain");
  }

  void check(const Eigen::Ref<const MatrixXd>& f) const {
    if (f.rows() != coordinates)
      throw std::invalid_argument("load has " + std::to_string(f.rows()) + " rows; expected " +
                                  std::to_string(coordinates));
    if (rigid.motions.cols() == 0) return;
    const MatrixXd work = rigid.motions.transpose() * f;
    const MatrixXd terms = rigid.motions.cwiseAbs().transpose() * f.cwiseAbs();
    if ((work.array().abs() > balanced * terms.array()).any())
      throw std::invalid_argument("the load does work in a rigid-body motion; expected one in balance");
  }

  void solve(const Eigen::Ref<const VectorXd>& f, Eigen::Ref<VectorXd> q, Eigen::Ref<VectorXd> forces) const {
    if (chain)
      chain->solve(f, q, forces);
    else if (refined)
      refined->solve(f, q, forces);
    else
      mixed->solve(f, q, forces);
  }

  void solve_carefully(const Eigen::Ref<const VectorXd>& f, Eigen::Ref<VectorXd> q,
                       Eigen::Ref<VectorXd> forces) const {
    if (chain)
      chain->solve_carefully(f, q, forces);
    else
      solve(f, q, forces);
  }
};

StiffnessSolver::StiffnessSolver(const StrainFactors& stiffness)
    : method_(std::make_unique<Method>(stiffness)) {}
StiffnessSolver::~StiffnessSolver() = default;
StiffnessSolver::StiffnessSolver(StiffnessSolver&&) noexcept = default;

const MatrixXd& StiffnessSolver::rigid_motions() const {
  return method_->rigid.motions;
}

bool StiffnessSolver::is_chain() const {
  return method_->chain.has_value();
}

void StiffnessSolver::solve_into(Eigen::Ref<const VectorXd> f, Eigen::Ref<VectorXd> coordinates,
                                 Eigen::Ref<VectorXd> natural_forces) const {
  method_->solve(f, coordinates, natural_forces);
}

StiffnessSolver::Solution StiffnessSolver::solve_with_forces(const VectorXd& f) const {
  method_->check(f);
  Solution solution{VectorXd(method_->coordinates), VectorXd::Zero(method_->strains)};
  method_->solve_carefully(f, solution.coordinates, solution.natural_forces);
  return solution;
}

MatrixXd StiffnessSolver::solve(const Eigen::Ref<const MatrixXd>& f) const {
  method_->check(f);
  MatrixXd coordinates(method_->coordinates, f.cols());
  VectorXd natural_forces = VectorXd::Zero(method_->strains);
  for (Index i = 0; i < f.cols(); ++i) method_->solve_carefully(f.col(i), coordinates.col(i), natural_forces);
  return coordinates;
}

VectorXd static_shape(const StructuralSystem& system, Index input, Index output) {
  const VectorXd q = response(system, input);
  return q / (system.outputs * q)[output];
}

double static_stiffness(const StructuralSystem& system, Index input, Index output) {
  return 1.0 / (system.outputs * response(system, input))[output];
}

}  // namespace beamid::fem
