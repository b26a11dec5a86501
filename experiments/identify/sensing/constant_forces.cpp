// What sensors read of forces that do not change.
#include <Eigen/LU>
#include <Eigen/SVD>

#include "experiments/identify/sensing/sensing_model.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Rank of what sensors read of constant forces (p x f), in parts of what it is made up of.
Index seen_combinations(const MatrixXd& read) {
  constexpr double rounding = 1e-8;
  if (read.size() == 0) return read.cols();
  return (Eigen::JacobiSVD<MatrixXd>(read).singularValues().array() > rounding).count();
}

}  // namespace

// Of a constant force the motion at rest, x = -A^-1 B; what the sensors read of it, beside what its parts
// are; nothing where there is no rest.
MatrixXd SensingModel::constant_forces_read(const VectorXd& theta) const {
  VectorXd state = VectorXd::Zero(start_.mean.size());
  state(model_.unknown_places) = parameters_at(theta);
  const Index all = motion_->motion_size(), r = 2 * model_.motion_size();
  MatrixXd a, b, h;
  motion_->motion_matrix(state, a);
  motion_->input_matrix(state, b);
  const VectorXd none = VectorXd::Zero(motion_->input_size());
  motion_->output_jacobian(state, none, h);
  const Eigen::FullPivLU<MatrixXd> solver(a.topLeftCorner(r, r));
  if (!solver.isInvertible() || all < r) return {};
  VectorXd rest, shown;
  motion_->output(state, none, rest);
  MatrixXd read(measured_, static_cast<Index>(forces_.size()));
  for (Index i = 0; i < read.cols(); ++i) {
    const Index input = forces_[static_cast<std::size_t>(i)].input;
    const VectorXd x = -solver.solve(b.col(input).head(r));
    VectorXd unit = none;
    unit[input] = 1.0;
    motion_->output(state, unit, shown);
    const VectorXd direct = (shown - rest).head(measured_);
    const VectorXd sum = direct + h.topLeftCorner(measured_, r) * x;
    const VectorXd size = direct.cwiseAbs() + h.topLeftCorner(measured_, r).cwiseAbs() * x.cwiseAbs();
    read.col(i) = (sum.array() / size.array().max(1e-300)).matrix();
  }
  return read;
}

int SensingModel::unseen_constant_forces(const VectorXd& theta) const {
  const MatrixXd read = constant_forces_read(theta);
  return static_cast<int>(read.cols() - seen_combinations(read));
}

std::vector<Index> SensingModel::sole_zeros(const VectorXd& theta) const {
  MatrixXd read = constant_forces_read(theta);
  const Index all = seen_combinations(read);
  std::vector<Index> sole;
  for (Index i = 0; i < read.rows(); ++i) {
    MatrixXd others = read;
    others.row(i).setZero();
    if (seen_combinations(others) < all) sole.push_back(i);
  }
  return sole;
}

}  // namespace beamid::experiments
