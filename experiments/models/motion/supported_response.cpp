#include "experiments/models/motion/supported_response.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <stdexcept>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;
using Complex = std::complex<double>;

LinearResponse::LinearResponse(const filters::LinearMotion& motion, const VectorXd& state) {
  constexpr double least_independence = 1e-12;  // reciprocal condition of V
  const Index l = motion.motion_size(), m = motion.input_size();
  VectorXd at = state;
  at.head(l).setZero();
  MatrixXd a, b, c;
  motion.motion_matrix(at, a);
  motion.input_matrix(at, b);
  motion.output_jacobian(at, VectorXd::Zero(m), c);
  if (!a.allFinite() || !b.allFinite() || !c.allFinite())
    throw std::runtime_error("the equations of motion are not finite at these unknowns");
  const Eigen::EigenSolver<MatrixXd> solver(a);
  if (solver.info() != Eigen::Success) throw std::runtime_error("the motion has no eigenvalues");
  shapes_ = solver.eigenvectors();
  const Eigen::PartialPivLU<MatrixXcd> back(shapes_);
  if (!(back.rcond() > least_independence))
    throw std::runtime_error("the motion has no independent eigenvectors at these unknowns");
  poles_ = solver.eigenvalues();
  inverse_ = back.inverse();
  sensors_ = c.leftCols(l) * shapes_;
  inputs_ = inverse_ * b;
  direct_.resize(c.rows(), m);
  VectorXd without, with;
  motion.output(at, VectorXd::Zero(m), without);
  for (Index j = 0; j < m; ++j) {
    motion.output(at, VectorXd::Unit(m, j), with);
    direct_.col(j) = with - without;
  }
}

namespace {

// 1 / z without the scaling that a complex division of the language does.
Complex inverse(Complex z) {
  return std::conj(z) / std::norm(z);
}

// e^(lambda_k dt).
VectorXcd decays(const VectorXcd& poles, double interval) {
  return (interval * poles.array()).exp().matrix();
}

}  // namespace

MatrixXcd LinearResponse::motion(const VectorXd& omega, double interval, const MatrixXcd& inputs,
                                 const VectorXd& difference) const {
  const Index l = poles_.size(), p = sensors_.rows();
  const VectorXcd decay = decays(poles_, interval), free = inverse_ * difference;
  MatrixXcd modal = inputs_ * inputs;
  for (Index k = 0; k < omega.size(); ++k) {
    const Complex back = std::polar(1.0, -omega[k] * interval);
    for (Index j = 0; j < l; ++j)
      modal(j, k) = modal(j, k) * inverse(Complex(0.0, omega[k]) - poles_[j]) +
                    free[j] * inverse(1.0 - decay[j] * back);
  }
  MatrixXcd found(p, omega.size());
  found.noalias() = sensors_ * modal;
  found.noalias() += direct_ * inputs;
  return found;
}

MatrixXcd LinearResponse::free_motions(const VectorXd& omega, double interval) const {
  const Index l = poles_.size(), p = sensors_.rows(), count = omega.size();
  const VectorXcd decay = decays(poles_, interval);
  MatrixXcd found(p * count, l);
  for (Index k = 0; k < count; ++k) {
    const Complex back = std::polar(1.0, -omega[k] * interval);
    for (Index j = 0; j < l; ++j)
      found.col(j).segment(k * p, p) = sensors_.col(j) * inverse(1.0 - decay[j] * back);
  }
  for (Index j = 0; j + 1 < l; ++j) {
    if (poles_[j].imag() == 0.0) continue;
    const VectorXcd first = found.col(j);
    found.col(j) += found.col(j + 1);
    found.col(j + 1) = Complex(0.0, 1.0) * (first - found.col(j + 1));
    ++j;
  }
  return found;
}

VectorXd LinearResponse::difference(const VectorXd& coefficients) const {
  VectorXcd modal = coefficients.cast<Complex>();
  for (Index j = 0; j + 1 < modal.size(); ++j) {
    if (poles_[j].imag() == 0.0) continue;
    modal[j] = Complex(coefficients[j], coefficients[j + 1]);
    modal[j + 1] = std::conj(modal[j]);
    ++j;
  }
  return (shapes_ * modal).real();
}

namespace {

// Whether what lies beside the diagonal is rounding, whatever the lengths of the eigenvectors.
bool is_diagonal(const MatrixXd& damping) {
  constexpr double rounding = 1e-8;
  for (Index i = 0; i < damping.rows(); ++i)
    for (Index j = 0; j < i; ++j)
      if (std::abs(damping(i, j) * damping(j, i)) > rounding * std::abs(damping(i, i) * damping(j, j)))
        return false;
  return true;
}

}  // namespace

SupportedResponse::SupportedResponse(const SecondOrderForm& form, const MatrixXd& rows, Index supports) {
  const Index n = form.stiffness.rows(), inside = n - supports;
  const Eigen::EigenSolver<MatrixXd> solver(form.stiffness.topLeftCorner(inside, inside));
  const VectorXd values = solver.eigenvalues().real();
  if (solver.info() != Eigen::Success ||
      !solver.eigenvalues().imag().isZero(1e-9 * values.cwiseAbs().maxCoeff()) || !(values.minCoeff() > 0.0))
    throw std::runtime_error("the part has no modes with its supports at rest");
  std::vector<Index> order(static_cast<std::size_t>(inside));
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return values[a] < values[b]; });
  const MatrixXd shapes = solver.eigenvectors().real()(Eigen::all, order);
  stiffness_ = values(order);
  frequencies_ = stiffness_.cwiseSqrt();
  const Eigen::PartialPivLU<MatrixXd> back(shapes);
  const MatrixXd of_supports = form.inputs.bottomRows(supports);
  MatrixXd damping = back.solve(form.damping.topLeftCorner(inside, inside) * shapes);
  pushed_ = back.solve(form.inputs.topRows(inside));
  held_ = back.solve(form.stiffness.topRightCorner(inside, supports) * of_supports);
  dragged_ = back.solve(form.damping.topRightCorner(inside, supports) * of_supports);
  rows_ = rows.leftCols(inside) * shapes;
  rows_of_supports_ = rows.rightCols(supports) * of_supports;
  damping_ = damping.diagonal();
  if (!is_diagonal(damping)) coupled_ = std::move(damping);
}

// s = -s'' / omega^2, s' = s'' / (i omega), a = -omega^2 h x.
MatrixXcd SupportedResponse::transfer(double omega) const {
  const double square = omega * omega;
  const Complex i_omega(0.0, omega);
  MatrixXcd force = pushed_ + held_ / square;
  force -= dragged_ / i_omega;
  MatrixXcd motion(force.rows(), force.cols());
  if (coupled_.size() == 0) {
    for (Index i = 0; i < motion.rows(); ++i)
      motion.row(i) = force.row(i) / (stiffness_[i] - square + i_omega * damping_[i]);
  } else {
    MatrixXcd dynamic = i_omega * coupled_;
    dynamic.diagonal().array() += stiffness_.array() - square;
    motion = dynamic.partialPivLu().solve(force);
  }
  return rows_of_supports_ - square * (rows_ * motion);
}

SupportedResponse::FreeMotion SupportedResponse::free_motion(Index count) const {
  count = std::min(count, stiffness_.size());
  MatrixXd first_order = MatrixXd::Zero(2 * count, 2 * count);
  first_order.topRightCorner(count, count).setIdentity();
  first_order.bottomLeftCorner(count, count).diagonal() = -stiffness_.head(count);
  if (coupled_.size() == 0)
    first_order.bottomRightCorner(count, count).diagonal() = -damping_.head(count);
  else
    first_order.bottomRightCorner(count, count) = -coupled_.topLeftCorner(count, count);
  const Eigen::EigenSolver<MatrixXd> solver(first_order);
  std::vector<Index> kept;
  for (Index j = 0; j < 2 * count; ++j)
    if (solver.eigenvalues()[j].imag() >= 0.0) kept.push_back(j);
  std::sort(kept.begin(), kept.end(), [&](Index a, Index b) {
    const Complex x = solver.eigenvalues()[a], y = solver.eigenvalues()[b];
    return std::pair(x.imag(), x.real()) < std::pair(y.imag(), y.real());
  });
  FreeMotion found{solver.eigenvalues()(kept), {}};
  const MatrixXcd shapes = solver.eigenvectors().topRows(count)(Eigen::all, kept);
  found.shapes =
      rows_.leftCols(count) * shapes * found.poles.cwiseAbs2().asDiagonal();  // in size; the phase is free
  return found;
}

}  // namespace beamid::experiments
