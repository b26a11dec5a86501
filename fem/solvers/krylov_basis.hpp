// The vectors that Lanczos builds.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fem/solvers/repeated_rows.hpp"
#include "fem/solvers/rigid_complement.hpp"
#include "fem/stiffness_solver.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {

/// Orthonormal vectors, V^T M V = I, of the Krylov space of K^-1 M, and the tridiagonal T = V^T M K^-1 M V
/// [parlett1998, ch. 13]. It starts from a random motion that K^-1 M has made smooth and rid of what has no
/// mass. Each vector is made orthogonal to the two before it, which is all that exact arithmetic asks for,
/// and then to all of them.
class KrylovBasis {
 public:
  /// @param seed of the motion it starts from.
  KrylovBasis(const StructuralSystem& system, const StiffnessSolver& solver,
              const RigidComplement& complement, std::uint64_t seed = 1);

  /// Appends a vector. @returns false when there is none left: the space is invariant.
  bool grow();

  Eigen::Index steps() const { return static_cast<Eigen::Index>(diagonal_.size()); }
  Eigen::VectorXd diagonal() const;         ///< of T (steps)
  Eigen::VectorXd beside_diagonal() const;  ///< of T (steps - 1)

  /// Norm of what the next vector was before it was normalised, the coupling of the space to the rest.
  double coupling() const { return coupling_; }

  /// V y for the columns of y (steps x k).
  Eigen::MatrixXd combine(const Eigen::MatrixXd& y) const;

 private:
  const StiffnessSolver& solver_;
  const RigidComplement& complement_;
  RepeatedRows mass_;
  std::vector<Eigen::MatrixXd> blocks_;  // of V, so many columns each: V grows without being copied
  std::vector<double> diagonal_, beside_;
  double coupling_ = 0.0;
  Eigen::VectorXd next_, load_, work_, natural_forces_;  // next vector of V and M times it

  Eigen::Ref<Eigen::VectorXd> column(Eigen::Index i);
  void apply_inverse();  // work = K^-1 load, without rigid motion
  void orthogonalise();  // work against V, given load = M work
  double norm() const;   // of work, given load = M work
};

}  // namespace beamid::fem
