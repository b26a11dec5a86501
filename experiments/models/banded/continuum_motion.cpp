#include "experiments/models/banded/continuum_motion.hpp"

#include <Eigen/SparseCholesky>
#include <cmath>
#include <stdexcept>

#include "experiments/models/banded/continuum_step.hpp"

namespace beamid::experiments {

using banded::BandedEquations, banded::ContinuumSensors;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

ContinuumMotion::ContinuumMotion(fem::ParametricSystem equations, MotionDescription description,
                                 const std::string& name) {
  if (!equations.system.nonlinear_forces.empty())
    throw std::invalid_argument("the system has nonlinear forces; expected a linear one");
  if (description.drives.size() != description.unknowns.size())
    throw std::invalid_argument(std::to_string(description.drives.size()) + " drives for " +
                                std::to_string(description.unknowns.size()) + " unknowns; expected one each");
  parts_ = std::make_shared<const Parts>(std::move(equations), std::move(description), name);
}

ContinuumMotion::~ContinuumMotion() = default;

Index ContinuumMotion::input_size() const {
  return static_cast<Index>(parts_->description.forces.size());
}

std::vector<filters::Label> ContinuumMotion::state_labels() const {
  return experiments::state_labels(parts_->description, parts_->layout, parts_->name);
}

std::vector<filters::Label> ContinuumMotion::output_labels() const {
  return experiments::output_labels(parts_->description);
}

void ContinuumMotion::rate(const VectorXd& state, const VectorXd& input, VectorXd& rate) const {
  BandedEquations equations = parts_->equations;
  equations.set(physical_values(parts_->description, parts_->layout, state));
  const Index n = parts_->layout.coordinates;
  const double *const q = state.data(), *const speed = q + n;
  VectorXd force = VectorXd::Zero(n), product = VectorXd::Zero(n);
  equations.stiffness().add_product(q, force.data());
  equations.stiffness().add_product(speed, product.data());
  force += equations.stiffness_damping() * product;
  equations.dashpots().now().add_product(speed, force.data());
  for (const ModeDamping& mode : equations.mode_dampings())
    force += mode.factor * mode.momentum.dot(state.segment(n, n)) * mode.momentum;
  force = equations.force(input) - force;

  fem::SparseMatrix mass = parts_->system.system.mass;
  for (std::size_t j = 0; j < parts_->system.derivatives.size(); ++j)
    mass += equations.change()[static_cast<Index>(j)] * parts_->system.derivatives[j].mass;
  rate.setZero(state.size());
  rate.head(n) = state.segment(n, n);
  rate.segment(n, n) = Eigen::SimplicialLDLT<fem::SparseMatrix>(mass).solve(force) -
                       equations.mass_damping() * state.segment(n, n);
  for (std::size_t i = 0; i < parts_->layout.drifts.size(); ++i)
    if (parts_->layout.drifts[i] >= 0) rate[parts_->layout.biases[i]] = state[parts_->layout.drifts[i]];
}

void ContinuumMotion::output(const VectorXd& state, const VectorXd& input, VectorXd& output) const {
  BandedEquations equations = parts_->equations;
  ContinuumSensors sensors = parts_->sensors;
  equations.set(physical_values(parts_->description, parts_->layout, state));
  sensors.set(equations);
  sensors.output(equations, state, input, output);
}

void ContinuumMotion::output_jacobian(const VectorXd& state, const VectorXd& input,
                                      MatrixXd& jacobian) const {
  BandedEquations equations = parts_->equations;
  ContinuumSensors sensors = parts_->sensors;
  const PhysicalValues values = physical_values(parts_->description, parts_->layout, state);
  equations.set(values);
  sensors.set(equations);
  sensors.jacobian(equations, values.slopes, state, input, jacobian);
}

std::unique_ptr<filters::DiscreteModel> ContinuumMotion::structured(double dt, const std::string& scheme,
                                                                    const filters::Noise& noise) const {
  if (scheme == "pade") return continuum_step(parts_, dt, noise);
  const Index n = parts_->layout.coordinates;
  if (n <= dense_limit && scheme != "exponential") return nullptr;
  const std::string instead =
      keeps_mode_shapes(parts_->system, parts_->description)
          ? "'pade', or the reduction modal_truncation: these unknowns leave the mode "
            "shapes as they are, so that it is exact for motion in the modes it keeps"
          : "'pade', or a reduction";
  throw std::invalid_argument("discretisation '" + scheme +
                              "' would take dense matrices of the whole mesh, " + std::to_string(n) +
                              " coordinates; expected " + instead);
}

namespace {

bool is_zero(const fem::SparseMatrix& matrix) {
  return matrix.nonZeros() == 0 || matrix.norm() == 0.0;
}

}  // namespace

bool keeps_mode_shapes(const fem::ParametricSystem& equations) {
  const fem::StrainFactors& own = equations.system.stiffness;
  const bool same_strains = equations.strain.rows() == own.strain.rows() &&
                            fem::SparseMatrix(equations.strain - own.strain).squaredNorm() == 0.0;
  const fem::SparseMatrix all = same_strains ? own.rigidity : own.assembled();
  for (std::size_t j = 0; j < equations.derivatives.size(); ++j) {
    if (!is_zero(equations.derivatives[j].mass)) return false;
    const fem::SparseMatrix part =
        same_strains ? equations.derivatives[j].rigidity : equations.stiffness_derivative(j);
    // s with D_j = s D, or K_j = s K, to the rounding of both
    const double share = part.cwiseProduct(all).sum() / all.squaredNorm();
    constexpr double rounding = 1e-12;
    if (fem::SparseMatrix(part - share * all).norm() > rounding * part.norm()) return false;
  }
  return true;
}

bool keeps_mode_shapes(const fem::ParametricSystem& equations, const MotionDescription& description) {
  for (const auto& derivative : equations.derivatives)
    if (!is_zero(derivative.damping)) return false;
  return description.forces.empty() && equations.system.nonlinear_forces.empty() &&
         is_zero(equations.system.damping) && keeps_mode_shapes(equations);
}

}  // namespace beamid::experiments
