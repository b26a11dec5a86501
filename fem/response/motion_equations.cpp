#include "fem/response/motion_equations.hpp"

#include <algorithm>

#include "fem/response/direct_damping.hpp"

namespace beamid::fem {

using Eigen::Index, Eigen::Ref, Eigen::VectorXd;

MotionEquations::MotionEquations(const ResponseProblem& problem, const std::string& method)
    : problem_(problem),
      law_(direct_damping(problem, method)),
      damping_(proportional_damping(problem.damping, problem.system)),
      stiffness_(problem.system.stiffness.assembled()),
      inputs_(problem.system.inputs),
      mass_(problem.system.mass),
      dashpots_(problem.system.damping),
      elastic_(problem.system.stiffness),
      mass_factor_(problem.system.mass, method + ": the mass matrix"),
      points_(problem.system.nonlinear_forces) {
  if (problem.system.damping.nonZeros() > 0) damping_ += problem.system.damping;
  // Every entry that the effective matrix can have, so that its pattern never changes.
  const auto positions = [](SparseMatrix matrix) {
    matrix.coeffs().setZero();
    return matrix;
  };
  pattern_ = positions(problem.system.mass) + positions(stiffness_) + positions(damping_);
  for (const NonlinearForce& force : problem.system.nonlinear_forces)
    pattern_ += positions(force.direction * force.direction.transpose());
  pattern_.makeCompressed();
  point_stiffness_.setZero(points_.empty() ? 0 : points_.directions().cols());
  point_damping_ = point_stiffness_;
}

VectorXd MotionEquations::initial_state() const {
  VectorXd state(2 * size());
  state << problem_.displacement, problem_.velocity;
  return state;
}

void MotionEquations::rate(double t, const Ref<const VectorXd>& y, Ref<VectorXd> y_rate) {
  const Index n = size();
  q_ = y.head(n);
  v_ = y.tail(n);
  force_.setZero(n);
  if (problem_.has_inputs()) {
    const Index last = problem_.inputs.cols() - 1;
    const double place = std::clamp(t / problem_.grid.interval, 0.0, static_cast<double>(last));
    const Index before = std::min(static_cast<Index>(place), std::max<Index>(last - 1, 0)),
                after = std::min(before + 1, last);
    const double part = place - static_cast<double>(before);
    force_.noalias() +=
        inputs_ * ((1.0 - part) * problem_.inputs.col(before) + part * problem_.inputs.col(after));
  }
  if (law_.mass != 0.0) {
    weighted_ = law_.mass * v_;
    mass_.subtract(weighted_, force_);
  }
  dashpots_.subtract(v_, force_);
  points_.subtract(q_, v_, force_);
  weighted_ = q_ + law_.stiffness * v_;
  elastic_.subtract(weighted_, force_);
  mass_factor_.solve_in_place(force_);
  y_rate.head(n) = v_;
  y_rate.tail(n) = force_;
}

const SparseMatrix& MotionEquations::effective_matrix(double gamma, const Ref<const VectorXd>& y) {
  gamma_ = gamma;
  effective_ = pattern_ + problem_.system.mass + gamma * damping_ + (gamma * gamma) * stiffness_;
  if (!points_.empty()) {
    const auto& c = points_.directions();
    point_stiffness_ = points_.stiffness(c.transpose() * y.head(size()));
    point_damping_ = points_.damping(c.transpose() * y.tail(size()));
    for (Index j = 0; j < c.cols(); ++j) {
      const SparseMatrix& direction = problem_.system.nonlinear_forces[j].direction;
      effective_ += (gamma * point_damping_[j] + gamma * gamma * point_stiffness_[j]) *
                    SparseMatrix(direction * direction.transpose());
    }
  }
  effective_.makeCompressed();
  return effective_;
}

const VectorXd& MotionEquations::reduce(const Ref<const VectorXd>& b) {
  right_.setZero(size());
  q_ = b.tail(size());
  mass_.add(q_, right_);
  q_ = gamma_ * b.head(size());
  elastic_.subtract(q_, right_);
  if (!points_.empty())
    right_ -= points_.directions() * point_stiffness_.cwiseProduct(points_.directions().transpose() * q_);
  return right_;
}

}  // namespace beamid::fem
