// (a K + b M + c C) q = f for complex a, b, c, with the digits of the strain factors.
#pragma once

#include <complex>
#include <memory>

#include <Eigen/Core>

#include "fem/stiffness_solver.hpp"
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

// One complex eigenvalue with its shape, made as good as double precision allows.

/// An approximate solution of (lambda^2 M + lambda C + K) phi = 0.
struct ComplexPair {
  std::complex<double> lambda;
  Eigen::VectorXcd shape;  ///< phi (n)
  double residual = 0.0;   ///< ||phi + K^-1 (lambda^2 M + lambda C) phi||_M / ||phi||_M
};

/// Rayleigh quotient iteration [lancaster1966]: phi becomes (lambda^2 M + lambda C + K)^-1 (2 lambda M + C)
/// phi, and lambda the nearer root of m lambda^2 + c lambda + k = 0, m = phi^T M phi and so on, which is
/// stationary for symmetric matrices. k is the energy N^T D^-1 N of the natural forces, where nothing
/// cancels.
class ComplexRefinement {
 public:
  ComplexRefinement(const StructuralSystem& system, const StiffnessSolver& solver)
      : system_(system), solver_(solver), dynamic_(system) {}

  /// Improves a pair for as long as its residual falls, at most three times, and sets the residual.
  void refine(ComplexPair& pair);

 private:
  double residual(std::complex<double> lambda, const Eigen::VectorXcd& shape) const;
  bool improve(ComplexPair& pair);

  const StructuralSystem& system_;
  const StiffnessSolver& solver_;
  DynamicStiffness dynamic_;
};

}  // namespace beamid::fem
