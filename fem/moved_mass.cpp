#include "fem/moved_mass.hpp"

#include <Eigen/SparseCholesky>

namespace beamid::fem {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

double moved_mass(const StructuralSystem& system, Index input) {
  const VectorXd moved = system.inputs.col(input);
  return moved.dot(Eigen::SimplicialLDLT<SparseMatrix>(system.mass).solve(moved));
}

double moved_share(const StructuralSystem& system, Index input, const MatrixXd& shapes) {
  const VectorXd moved = system.inputs.col(input);
  const double all = moved_mass(system, input);
  return all > 0.0 ? (shapes.transpose() * moved).squaredNorm() / all : 1.0;
}

}  // namespace beamid::fem
