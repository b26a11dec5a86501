#include "experiments/models/motion/reduced_motion.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Below this share of the diagonal a coupling is what rounding left of none.
constexpr double negligible = 1e-9;

bool is_diagonal(const MatrixXd& matrix, const VectorXd& size) {
  for (Index i = 0; i < matrix.rows(); ++i)
    for (Index j = 0; j < matrix.cols(); ++j)
      if (i != j && std::abs(matrix(i, j)) > negligible * std::sqrt(size[i] * size[j])) return false;
  return true;
}

void make_diagonal(MatrixXd& matrix) {
  matrix = MatrixXd(matrix.diagonal().asDiagonal());
}

}  // namespace

std::vector<DampedMode> damped_modes(const ReducedEquations& equations) {
  const Index r = equations.mass.size();
  const auto a = static_cast<Index>(equations.derivatives.size());
  std::vector<DampedMode> modes;
  for (Index i = 0; i < r; ++i) {
    if (equations.stiffness[i] <= 0.0) continue;
    const double scale = 1.0 / std::sqrt(equations.mass[i]);  // phi = scale e_i
    DampedMode mode;
    mode.momentum = VectorXd::Unit(r, i) * (equations.mass[i] * scale);
    mode.momentum_slopes.resize(r, a);
    mode.mass_slopes.resize(a);
    mode.stiffness_slopes.resize(a);
    mode.stiffness = equations.stiffness[i] / equations.mass[i];
    for (Index j = 0; j < a; ++j) {
      const ReducedEquations::Derivative& slope = equations.derivatives[static_cast<std::size_t>(j)];
      mode.momentum_slopes.col(j) = scale * slope.mass.col(i);
      mode.mass_slopes[j] = slope.mass(i, i) / equations.mass[i];
      mode.stiffness_slopes[j] = slope.stiffness(i, i) / equations.mass[i];
    }
    modes.push_back(mode);
  }
  return modes;
}

ReducedMotion::ReducedMotion(ReducedEquations equations, MotionDescription description, MatrixXd rows,
                             std::string name)
    : SecondOrderMotion(std::move(description), std::move(rows), std::move(name)),
      equations_(std::move(equations)) {
  const VectorXd omega = frequencies();
  const VectorXd rate = equations_.mass.cwiseProduct(omega);
  decoupled_ = is_diagonal(equations_.damping, rate);
  for (const ReducedEquations::Derivative& slope : equations_.derivatives)
    decoupled_ = decoupled_ && is_diagonal(slope.mass, slope.mass.diagonal().cwiseAbs()) &&
                 is_diagonal(slope.stiffness, slope.stiffness.diagonal().cwiseAbs()) &&
                 (slope.damping.size() == 0 || is_diagonal(slope.damping, slope.damping.diagonal()));
  if (!decoupled_) return;
  make_diagonal(equations_.damping);
  for (ReducedEquations::Derivative& slope : equations_.derivatives) {
    make_diagonal(slope.mass);
    make_diagonal(slope.stiffness);
    if (slope.damping.size() > 0) make_diagonal(slope.damping);
  }
}

VectorXd ReducedMotion::frequencies() const {
  VectorXd omega = (equations_.stiffness.array() / equations_.mass.array()).cwiseMax(0.0).sqrt();
  const double largest = omega.maxCoeff();
  return omega.cwiseMax(largest > 0.0 ? 1e-3 * largest : 1.0);
}

void ReducedMotion::evaluate(const VectorXd& state, SecondOrderForm& form,
                             std::vector<SecondOrderForm>* slopes) const {
  const MotionDescription& given = description();
  const PhysicalValues at = physical_values(given, layout(), state);
  MatrixXd mass = equations_.mass.asDiagonal(), stiffness = equations_.stiffness.asDiagonal();
  MatrixXd inputs = equations_.inputs, dashpots = equations_.damping;
  bool lumped = decoupled_;
  for (Index j = 0; j < given.properties(); ++j) {
    const ReducedEquations::Derivative& slope = equations_.derivatives[static_cast<std::size_t>(j)];
    const double change = at.change[j];
    if (change == 0.0) continue;
    mass += change * slope.mass;
    stiffness += change * slope.stiffness;
    inputs += change * slope.inputs;
    if (slope.damping.size() > 0) dashpots += change * slope.damping;
  }
  if (lumped && !(mass.diagonal().minCoeff() > 0.0))
    throw std::runtime_error("the parameters leave a mode without mass");
  MatrixXd damping = dashpots + at.mass_damping * mass + at.stiffness_damping * stiffness;
  std::vector<ModeDamping> modes;
  for (std::size_t i = 0; i < given.damped_modes.size(); ++i) {
    modes.push_back(damping_at(given.damped_modes[i], at.change, at.ratios[static_cast<Index>(i)]));
    const VectorXd& g = modes.back().momentum;
    damping.noalias() += (modes.back().factor * g) * g.transpose();
  }

  Eigen::LLT<MatrixXd> factor;
  const VectorXd inverse = mass.diagonal().cwiseInverse();
  if (!lumped) {
    factor.compute(mass);
    if (factor.info() != Eigen::Success)
      throw std::runtime_error("the parameters make the mass matrix indefinite");
  }
  const auto divide = [&](MatrixXd& matrix) {
    if (matrix.cols() == 0) return;
    if (lumped)
      matrix = inverse.asDiagonal() * matrix;
    else
      factor.solveInPlace(matrix);
  };
  form.stiffness = stiffness;
  form.damping = damping;
  form.inputs = inputs;
  for (MatrixXd* matrix : {&form.stiffness, &form.damping, &form.inputs}) divide(*matrix);
  if (!slopes) return;

  slopes->resize(given.unknowns.size());
  for (std::size_t j = 0; j < given.unknowns.size(); ++j) {
    const Drive& drive = given.drives[j];
    SecondOrderForm& slope = (*slopes)[j];
    const double chain = at.slopes[static_cast<Index>(j)];
    if (drive.kind == Drive::Kind::property) {
      const ReducedEquations::Derivative& by = equations_.derivatives[static_cast<std::size_t>(drive.index)];
      slope.stiffness = by.stiffness;
      slope.stiffness.noalias() -= by.mass * form.stiffness;
      slope.damping = at.mass_damping * by.mass + at.stiffness_damping * by.stiffness;
      if (by.damping.size() > 0) slope.damping += by.damping;
      for (std::size_t i = 0; i < modes.size(); ++i) {
        const VectorXd& g = modes[i].momentum;
        const auto turn = given.damped_modes[i].momentum_slopes.col(drive.index);
        slope.damping.noalias() += (modes[i].by_property[drive.index] * g) * g.transpose();
        slope.damping.noalias() += (modes[i].factor * turn) * g.transpose();
        slope.damping.noalias() += (modes[i].factor * g) * turn.transpose();
      }
      slope.damping.noalias() -= by.mass * form.damping;
      slope.inputs = by.inputs;
      slope.inputs.noalias() -= by.mass * form.inputs;
    } else {
      slope.stiffness.setZero(mass.rows(), mass.cols());
      slope.damping.setZero(mass.rows(), mass.cols());
      slope.inputs.setZero(inputs.rows(), inputs.cols());
      if (drive.kind == Drive::Kind::mass_damping) slope.damping = mass;
      if (drive.kind == Drive::Kind::stiffness_damping) slope.damping = stiffness;
      for (std::size_t i = 0; i < modes.size() && drive.kind == Drive::Kind::damping_ratio; ++i)
        if (given.damped_modes[i].unknown == static_cast<Index>(j))
          slope.damping.noalias() += (modes[i].by_ratio * modes[i].momentum) * modes[i].momentum.transpose();
    }
    for (MatrixXd* matrix : {&slope.stiffness, &slope.damping, &slope.inputs}) {
      *matrix *= chain;
      divide(*matrix);
    }
  }
}

}  // namespace beamid::experiments
