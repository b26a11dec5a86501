#include "fem/response/modal_basis.hpp"

#include <stdexcept>
#include <string>

#include "fem/stiffness_solver.hpp"

namespace beamid::fem {

using Eigen::Index, Eigen::MatrixXd;

ModalBasis modal_basis(const StructuralSystem& system, const DampingLaw& damping, Index count) {
  const Index n = system.size();
  if (count < 0 || count > n)
    throw std::invalid_argument("modal method: " + std::to_string(count) + " modes; expected 1 to " +
                                std::to_string(n) + ", or 0 to leave the choice");
  ModalBasis basis;
  basis.modes = modes(system, count > 0 ? count : (n <= 200 ? n : Index{100}));
  const MatrixXd& shape = basis.modes.shape;
  basis.square = basis.modes.angular_frequency.cwiseAbs2();
  if (std::holds_alternative<StructuralDamping>(damping))
    basis.rate.setZero(basis.square.size());
  else
    basis.rate = damping_rates(damping, basis.modes.angular_frequency);
  if (system.damping.nonZeros() > 0) basis.coupling = shape.transpose() * (system.damping * shape);
  basis.loads = shape.transpose() * system.inputs;
  basis.observed = system.outputs * shape;
  return basis;
}

MatrixXd residual_deflection(const StructuralSystem& system, const ModalBasis& basis) {
  const MatrixXd& shape = basis.modes.shape;
  MatrixXd unseen = system.inputs;
  for (int pass = 0; pass < 2; ++pass) unseen -= system.mass * (shape * (shape.transpose() * unseen));
  // What the modes take up whole, as rigid-body motions do an acceleration of the base, leaves rounding only.
  for (Index j = 0; j < unseen.cols(); ++j)
    if (unseen.col(j).norm() <= 1e-12 * system.inputs.col(j).norm()) unseen.col(j).setZero();
  const MatrixXd deflection = StiffnessSolver(system.stiffness).solve(unseen);
  return deflection - shape * (shape.transpose() * (system.mass * deflection));
}

}  // namespace beamid::fem
