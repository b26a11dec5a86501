// Static solutions that keep the digits of the strain factors.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "fem/structural_system.hpp"

namespace beamid::fem {

/// Solves K q = f through the factors of K = B^T D B, that is for the coordinates q and the natural forces N
/// of
///
///     B^T N = f   (equilibrium),      B q = D^-1 N   (compatibility).
///
/// Nothing is ever subtracted that the assembled K would have cancelled. Where the structure is a chain, two
/// sweeps along it solve both, with a small dense system for a handful of redundant constraints
/// (solvers/chain_solver.hpp); anything else, as a beam under axial load or a reduced model, is solved as one
/// mixed system (solvers/mixed_solver.hpp), or where it is large, as a building in space, by the assembled K
/// and corrections (solvers/refined_solver.hpp).
///
/// A structure that can move without strain is solved too, for loads that balance on its rigid-body motions;
/// of the many solutions it gives one that holds some coordinates at rest.
class StiffnessSolver {
 public:
  struct Solution {
    Eigen::VectorXd coordinates;     ///< q (n)
    Eigen::VectorXd natural_forces;  ///< N (s), conjugate to the strains
  };

  /// @throws std::runtime_error when the stiffness is singular for a reason other than rigid-body motions.
  explicit StiffnessSolver(const StrainFactors& stiffness);
  ~StiffnessSolver();
  StiffnessSolver(StiffnessSolver&&) noexcept;

  /// Basis of the motions without strain, B r = 0 (n x k), each with a largest entry of 1; k = 0 for a
  /// structure.
  const Eigen::MatrixXd& rigid_motions() const;

  /// q = K^-1 f for f (n x k). @throws std::invalid_argument when f has not n rows or does work in a rigid
  /// motion.
  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& f) const;

  /// The same for one load f (n), with the natural forces.
  Solution solve_with_forces(const Eigen::VectorXd& f) const;

  /// The same into vectors that have their sizes already, (n) and (s), none of which may be f: as fast as it
  /// can be, at the price of a few digits of a very long chain. The caller answers for the balance of f: what
  /// it does in a rigid motion is left out.
  void solve_into(Eigen::Ref<const Eigen::VectorXd> f, Eigen::Ref<Eigen::VectorXd> coordinates,
                  Eigen::Ref<Eigen::VectorXd> natural_forces) const;

  /// Whether the sweeps serve it.
  bool is_chain() const;

 private:
  struct Method;
  std::unique_ptr<Method> method_;
};

/// Shape (n) that a static force on input `input` gives, scaled to 1 at output `output`.
/// @throws std::runtime_error when the structure can move without strain.
Eigen::VectorXd static_shape(const StructuralSystem& system, Eigen::Index input = 0, Eigen::Index output = 0);

/// Force on input `input` per displacement at output `output` [N/m].
/// @throws std::runtime_error when the structure can move without strain.
double static_stiffness(const StructuralSystem& system, Eigen::Index input = 0, Eigen::Index output = 0);

}  // namespace beamid::fem
