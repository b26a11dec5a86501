// Static deflections of structures that may float.
#pragma once

#include <Eigen/Core>

#include "fem/solvers/rigid_complement.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::reduction {

/// q = K^-1 f; of a structure that can move without strain, the deflection of the load that is left when the
/// inertia of its rigid-body acceleration balances it, taken orthogonal (M) to the rigid-body modes R:
///
///     q = (I - R R^T M) K^- (I - M R R^T) f
class ElasticStatics {
 public:
  /// @throws std::runtime_error when the stiffness is singular for a reason other than rigid-body motions.
  explicit ElasticStatics(const fem::StructuralSystem& system)
      : solver_(system.stiffness), complement_(system.mass, solver_.rigid_motions()) {}

  /// q (n) of the load f (n).
  Eigen::VectorXd solve(const Eigen::VectorXd& load) const {
    Eigen::VectorXd balanced = load;
    for (int pass = 0; pass < 2; ++pass) complement_.project_load(balanced);
    // What the rigid-body acceleration takes up whole, as that of the base, leaves rounding only.
    if (!(balanced.norm() > 1e-12 * load.norm())) return Eigen::VectorXd::Zero(load.size());
    Eigen::VectorXd motion = solver_.solve(balanced);
    for (int pass = 0; pass < 2; ++pass) complement_.project_motion(motion);
    return motion;
  }

  const Eigen::MatrixXd& rigid_modes() const { return complement_.modes(); }  ///< R (n x k), R^T M R = I

 private:
  fem::StiffnessSolver solver_;
  fem::RigidComplement complement_;
};

}  // namespace beamid::reduction
