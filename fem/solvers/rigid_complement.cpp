#include "fem/solvers/rigid_complement.hpp"

#include <Eigen/Cholesky>
#include <stdexcept>

namespace beamid::fem {

RigidComplement::RigidComplement(const SparseMatrix& mass, const Eigen::MatrixXd& motions) : modes_(motions) {
  if (motions.cols() == 0) return;
  // Twice: the first leaves what rounding costs a basis that is far from orthogonal.
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::LLT<Eigen::MatrixXd> gram(modes_.transpose() * (mass * modes_));
    if (gram.info() != Eigen::Success)
      throw std::runtime_error("modes: a rigid-body motion of the structure has no mass");
    modes_ = gram.matrixU().solve<Eigen::OnTheRight>(modes_).eval();
  }
  loads_ = mass * modes_;
}

}  // namespace beamid::fem
