// The assembled stiffness, and the strain factors that give back the digits it has lost.
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "fem/structural_system.hpp"

namespace beamid::fem {

// The strain factors as one sparse system.

/// Solves for coordinates q and natural forces N together,
///
///     [ -D^-1  B ] [ N ]   [ 0 ]
///     [  B^T   0 ] [ q ] = [ f ]
///
/// by sparse LU (UMFPACK [davis2004]). It serves any structure, at several times the time and memory of the
/// sweeps of a chain.
class MixedSolver {
 public:
  /// @param held coordinates kept at zero. @throws std::runtime_error when the matrix is singular.
  explicit MixedSolver(const StrainFactors& stiffness, const std::vector<int>& held = {});
  ~MixedSolver();
  MixedSolver(MixedSolver&&) noexcept;

  /// q (n) and N (s) of the load f (n).
  void solve(Eigen::Ref<const Eigen::VectorXd> f, Eigen::Ref<Eigen::VectorXd> coordinates,
             Eigen::Ref<Eigen::VectorXd> natural_forces) const;

 private:
  struct Factorisation;
  std::unique_ptr<Factorisation> factorisation_;
};

/// Solves for coordinates q and natural forces N what the mixed solver solves, by the Cholesky factors of
/// K = B^T D B (CHOLMOD [chen2008]) and corrections from the strain factors. With what is left of equilibrium
/// and compatibility, g = f - B^T N and e = D^-1 N - B q,
///
///     K dq = g + B^T D e,     dN = D (B dq - e).
///
/// The factors of K err by its condition number; each correction makes the error smaller by as much, until
/// only that of g and e is left, in which nothing cancels. In space, where the mixed matrix fills up, it
/// takes a hundredth of its time; where K has too few digits to begin with, it says so and the mixed solver
/// serves.
class RefinedSolver {
 public:
  /// @param held coordinates kept at zero
  RefinedSolver(const StrainFactors& stiffness, const std::vector<int>& held);
  ~RefinedSolver();
  RefinedSolver(RefinedSolver&&) noexcept;

  /// Whether K was positive definite and corrections become small, tried with a load.
  bool serves() const;

  /// q (n) and N (s) of the load f (n).
  void solve(Eigen::Ref<const Eigen::VectorXd> f, Eigen::Ref<Eigen::VectorXd> coordinates,
             Eigen::Ref<Eigen::VectorXd> natural_forces) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace beamid::fem
