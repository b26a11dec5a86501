#include "tests/experiments/models/banded/dense_continuum.hpp"

namespace beamid::test {

using namespace experiments;

std::vector<filters::Label> DenseContinuum::state_labels() const {
  return experiments::state_labels(description_, layout_, "coordinate");
}

std::vector<filters::Label> DenseContinuum::output_labels() const {
  return experiments::output_labels(description_);
}

DenseContinuum::Matrices DenseContinuum::matrices(const Eigen::VectorXd& state) const {
  const PhysicalValues at = physical_values(description_, layout_, state);
  const fem::SparseMatrix& b = equations_.strain;
  Matrices m{equations_.system.mass, equations_.system.damping,
             Eigen::MatrixXd(equations_.system.stiffness.assembled()), chosen(equations_.system.inputs)};
  for (Eigen::Index j = 0; j < at.change.size(); ++j) {
    const auto& slope = equations_.derivatives[static_cast<std::size_t>(j)];
    m.mass += at.change[j] * Eigen::MatrixXd(slope.mass);
    m.stiffness += at.change[j] * Eigen::MatrixXd(b.transpose() * slope.rigidity * b);
    m.inputs += at.change[j] * chosen(slope.inputs);
    if (slope.damping.nonZeros() > 0) m.damping += at.change[j] * Eigen::MatrixXd(slope.damping);
  }
  m.damping += at.mass_damping * m.mass + at.stiffness_damping * m.stiffness;
  for (std::size_t i = 0; i < description_.damped_modes.size(); ++i) {
    const ModeDamping mode =
        damping_at(description_.damped_modes[i], at.change, at.ratios[static_cast<Eigen::Index>(i)]);
    m.damping += mode.factor * mode.momentum * mode.momentum.transpose();
  }
  return m;
}

DenseContinuum::Matrices DenseContinuum::slopes(const Eigen::VectorXd& state, Eigen::Index j) const {
  const PhysicalValues at = physical_values(description_, layout_, state);
  const Matrices m = matrices(state);
  const Drive& drive = description_.drives[static_cast<std::size_t>(j)];
  const Eigen::Index n = layout_.coordinates;
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(n, n);
  Matrices d{zero, zero, zero, Eigen::MatrixXd::Zero(n, input_size())};
  if (drive.kind == Drive::Kind::mass_damping) d.damping = m.mass;
  if (drive.kind == Drive::Kind::stiffness_damping) d.damping = m.stiffness;
  if (drive.kind == Drive::Kind::property) {
    const fem::SparseMatrix& b = equations_.strain;
    const auto& slope = equations_.derivatives[static_cast<std::size_t>(drive.index)];
    d.mass = Eigen::MatrixXd(slope.mass);
    d.stiffness = Eigen::MatrixXd(b.transpose() * slope.rigidity * b);
    d.inputs = chosen(slope.inputs);
    d.damping = at.mass_damping * d.mass + at.stiffness_damping * d.stiffness;
    if (slope.damping.nonZeros() > 0) d.damping += Eigen::MatrixXd(slope.damping);
  }
  for (std::size_t i = 0; i < description_.damped_modes.size(); ++i) {
    const DampedMode& damped = description_.damped_modes[i];
    const ModeDamping mode = damping_at(damped, at.change, at.ratios[static_cast<Eigen::Index>(i)]);
    if (drive.kind == Drive::Kind::damping_ratio && damped.unknown == j)
      d.damping += mode.by_ratio * mode.momentum * mode.momentum.transpose();
    if (drive.kind != Drive::Kind::property) continue;
    const Eigen::VectorXd slope = damped.momentum_slopes.col(drive.index);
    d.damping += mode.by_property[drive.index] * mode.momentum * mode.momentum.transpose() +
                 mode.factor * (slope * mode.momentum.transpose() + mode.momentum * slope.transpose());
  }
  return d;
}

void DenseContinuum::motion_matrix(const Eigen::VectorXd& state, Eigen::MatrixXd& matrix) const {
  const Eigen::Index n = layout_.coordinates;
  const Matrices m = matrices(state);
  const Eigen::LLT<Eigen::MatrixXd> mass(m.mass);
  matrix.setZero(layout_.motion, layout_.motion);
  matrix.block(0, n, n, n).setIdentity();
  matrix.block(n, 0, n, n) = -mass.solve(m.stiffness);
  matrix.block(n, n, n, n) = -mass.solve(m.damping);
  for (std::size_t i = 0; i < layout_.drifts.size(); ++i)
    if (layout_.drifts[i] >= 0) matrix(layout_.biases[i], layout_.drifts[i]) = 1.0;
}

void DenseContinuum::motion_matrix_derivative(const Eigen::VectorXd& state, Eigen::Index j,
                                              Eigen::MatrixXd& matrix) const {
  const Eigen::Index n = layout_.coordinates;
  matrix.setZero(layout_.motion, layout_.motion);
  if (j >= static_cast<Eigen::Index>(description_.unknowns.size())) return;
  const Matrices m = matrices(state), d = slopes(state, j);
  const Eigen::LLT<Eigen::MatrixXd> mass(m.mass);
  const double slope = physical_values(description_, layout_, state).slopes[j];
  matrix.block(n, 0, n, n) = -slope * mass.solve(d.stiffness - d.mass * mass.solve(m.stiffness)).eval();
  matrix.block(n, n, n, n) = -slope * mass.solve(d.damping - d.mass * mass.solve(m.damping)).eval();
}

void DenseContinuum::input_matrix(const Eigen::VectorXd& state, Eigen::MatrixXd& matrix) const {
  const Matrices m = matrices(state);
  matrix.setZero(layout_.motion, input_size());
  matrix.middleRows(layout_.coordinates, layout_.coordinates) = m.mass.llt().solve(m.inputs);
}

void DenseContinuum::input_matrix_derivative(const Eigen::VectorXd& state, Eigen::Index j,
                                             Eigen::MatrixXd& matrix) const {
  matrix.setZero(layout_.motion, input_size());
  if (j >= static_cast<Eigen::Index>(description_.unknowns.size())) return;
  const Matrices m = matrices(state), d = slopes(state, j);
  const Eigen::LLT<Eigen::MatrixXd> mass(m.mass);
  matrix.middleRows(layout_.coordinates, layout_.coordinates) =
      physical_values(description_, layout_, state).slopes[j] *
      mass.solve(d.inputs - d.mass * mass.solve(m.inputs)).eval();
}

void DenseContinuum::output(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                            Eigen::VectorXd& output) const {
  Eigen::MatrixXd a, b;
  motion_matrix(state, a);
  input_matrix(state, b);
  Eigen::VectorXd moving = a * state.head(layout_.motion);
  if (input_size() > 0) moving += b * input;
  const Eigen::MatrixXd rows = equations_.system.outputs;
  const Eigen::Index n = layout_.coordinates;
  output.resize(rows.rows());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const Reads what = reads(description_.observations[static_cast<std::size_t>(i)].quantity);
    output[i] = what == Reads::coordinates ? rows.row(i).dot(state.head(n))
                : what == Reads::rates     ? rows.row(i).dot(state.segment(n, n))
                                           : rows.row(i).dot(moving.segment(n, n));
    if (what != Reads::accelerations) continue;
    if (description_.base >= 0) output[i] += input[description_.base];
    const Eigen::Index bias = layout_.biases[static_cast<std::size_t>(i)];
    if (bias >= 0) output[i] += state[bias];
  }
}

void DenseContinuum::output_jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                                     Eigen::MatrixXd& jacobian) const {
  Eigen::MatrixXd moving;
  rate_jacobian(state, input, moving);
  const Eigen::MatrixXd rows = equations_.system.outputs;
  const Eigen::Index n = layout_.coordinates;
  jacobian.setZero(rows.rows(), layout_.size);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const Reads what = reads(description_.observations[static_cast<std::size_t>(i)].quantity);
    if (what == Reads::coordinates) jacobian.row(i).head(n) = rows.row(i);
    if (what == Reads::rates) jacobian.row(i).segment(n, n) = rows.row(i);
    if (what != Reads::accelerations) continue;
    jacobian.row(i) = rows.row(i) * moving.middleRows(n, n);
    const Eigen::Index bias = layout_.biases[static_cast<std::size_t>(i)];
    if (bias >= 0) jacobian(i, bias) += 1.0;
  }
}

Eigen::MatrixXd DenseContinuum::chosen(const fem::SparseMatrix& matrix) const {
  Eigen::MatrixXd result(matrix.rows(), input_size());
  for (Eigen::Index k = 0; k < result.cols(); ++k)
    result.col(k) = Eigen::VectorXd(matrix.col(description_.forces[static_cast<std::size_t>(k)]));
  return result;
}

std::vector<DampedMode> damped_modes(const fem::ParametricSystem& equations,
                                     const std::vector<double>& ratios) {
  const fem::StructuralSystem& system = equations.system;
  const auto a = static_cast<Eigen::Index>(equations.derivatives.size());
  const fem::Modes modes = fem::modes(system, static_cast<Eigen::Index>(ratios.size()));
  std::vector<DampedMode> result;
  for (Eigen::Index i = 0; i < modes.size(); ++i) {
    const Eigen::VectorXd phi = modes.shape.col(i), strain = equations.strain * phi;
    DampedMode mode{system.mass * phi,
                    Eigen::MatrixXd(system.size(), a),
                    Eigen::VectorXd(a),
                    system.stiffness.energy(phi),
                    Eigen::VectorXd(a),
                    ratios[static_cast<std::size_t>(i)],
                    -1};
    for (Eigen::Index j = 0; j < a; ++j) {
      const auto& slope = equations.derivatives[static_cast<std::size_t>(j)];
      mode.momentum_slopes.col(j) = slope.mass * phi;
      mode.mass_slopes[j] = phi.dot(mode.momentum_slopes.col(j));
      mode.stiffness_slopes[j] = strain.dot(slope.rigidity * strain);
    }
    result.push_back(std::move(mode));
  }
  return result;
}

}  // namespace beamid::test
