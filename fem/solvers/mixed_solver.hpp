// The strain factors as one sparse system.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fem/structural_system.hpp"

namespace beamid::fem {

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

}  // namespace beamid::fem
