#include "experiments/models/motion/linear_response.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <complex>
#include <stdexcept>

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
  const MatrixXcd shapes = solver.eigenvectors();
  const Eigen::PartialPivLU<MatrixXcd> back(shapes);
  if (!(back.rcond() > least_independence))
    throw std::runtime_error("the motion has no independent eigenvectors at these unknowns");
  poles_ = solver.eigenvalues();
  inverse_ = back.inverse();
  sensors_ = c.leftCols(l) * shapes;
  inputs_ = inverse_ * b;
  direct_.resize(c.rows(), m);
  VectorXd without, with;
  motion.output(at, VectorXd::Zero(m), without);
  for (Index j = 0; j < m; ++j) {
    motion.output(at, VectorXd::Unit(m, j), with);
    direct_.col(j) = with - without;
  }
}

void LinearResponse::line(double omega, double interval, MatrixXcd& transfer, MatrixXcd& free) const {
  const VectorXcd gains = (Complex(0.0, omega) - poles_.array()).inverse().matrix();
  transfer.noalias() = sensors_ * gains.asDiagonal() * inputs_;
  transfer += direct_;
  const Complex back = std::exp(Complex(0.0, -omega * interval));
  const VectorXcd sums = (1.0 - (interval * poles_).array().exp() * back).inverse().matrix();
  free.noalias() = sensors_ * sums.asDiagonal() * inverse_;
}

}  // namespace beamid::experiments
