// One complex eigenvalue with its shape, made as good as double precision allows.
#pragma once

#include <Eigen/Core>
#include <complex>

#include "fem/response/dynamic_stiffness.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::fem {

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
