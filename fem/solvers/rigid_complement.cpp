#include "fem/solvers/rigid_complement.hpp"

#include <Eigen/Cholesky>
#include <stdexcept>
#include <utility>

namespace beamid::fem {

RigidComplement::RigidComplement(const SparseMatrix& mass, Eigen::MatrixXd motions)
    : modes_(std::move(motions)) {
  if (count() == 0) return;
  // Twice: the first leaves what rounding costs a basis that is far from orthogonal.
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::LLT<Eigen::MatrixXd> gram(modes_.transpose() * (mass * modes_));
    if (gram.info() != Eigen::Success)
      throw std::runtime_error("modes: a rigid-body motion of the structure has no mass");
    gram.matrixU().solveInPlace<Eigen::OnTheRight>(modes_);
  }
  loads_ = mass * modes_;
}

}  // namespace beamid::fem
