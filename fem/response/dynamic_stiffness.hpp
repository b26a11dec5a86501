// (a K + b M + c C) q = f for complex a, b, c, with the digits of the strain factors.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <memory>

#include "fem/structural_system.hpp"

namespace beamid::fem {

/// Solves
///
///     [ -D^-1 / a       B      ] [ N ]   [ 0 ]
///     [   B^T      b M + c C   ] [ q ] = [ f ]      (N: natural forces)
///
/// by complex sparse LU (UMFPACK [davis2004]), its pattern analysed once.
class DynamicStiffness {
 public:
  explicit DynamicStiffness(const StructuralSystem& system);
  ~DynamicStiffness();

  /// @returns false when the matrix is singular.
  bool factor(std::complex<double> stiffness, std::complex<double> mass, std::complex<double> damping);

  struct Solution {
    Eigen::MatrixXcd coordinates;     ///< q (n x k)
    Eigen::MatrixXcd natural_forces;  ///< N (s x k)
  };
  /// @param force f (n x k)
  Solution solve(const Eigen::MatrixXcd& force) const;

 private:
  struct Factorisation;
  std::unique_ptr<Factorisation> factorisation_;
};

}  // namespace beamid::fem
