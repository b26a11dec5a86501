#include "fem/stiffness_solver.hpp"

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "fem/solvers/chain_solver.hpp"
#include "fem/solvers/mixed_solver.hpp"
#include "fem/solvers/refined_solver.hpp"

namespace beamid::fem {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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

}  // namespace

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
