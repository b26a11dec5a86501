// Static solutions that keep the digits of the strain factors.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "fem/structural_system.hpp"

namespace beamid::fem {

/// Solves K q = f through the factors of K = B^T D B, as the mixed system
///
///     [ -D^-1  B ] [ N ]   [ 0 ]
///     [  B^T   0 ] [ q ] = [ f ]      (N: natural forces)
///
/// by sparse LU (UMFPACK [davis2004]). Nothing is ever subtracted that the assembled K would have cancelled.
class StiffnessSolver {
 public:
  /// @throws std::runtime_error when the stiffness is singular (a mechanism).
  explicit StiffnessSolver(const StrainFactors& stiffness);
  ~StiffnessSolver();
  StiffnessSolver(StiffnessSolver&&) noexcept;

  /// q = K^-1 f for f (n x k).
  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& f) const;

 private:
  struct Factorisation;
  std::unique_ptr<Factorisation> factorisation_;
};

/// Shape (n) that a static force on input `input` gives, scaled to 1 at output `output`.
Eigen::VectorXd static_shape(const StructuralSystem& system, Eigen::Index input = 0, Eigen::Index output = 0);

/// Force on input `input` per displacement at output `output` [N/m].
double static_stiffness(const StructuralSystem& system, Eigen::Index input = 0, Eigen::Index output = 0);

}  // namespace beamid::fem
