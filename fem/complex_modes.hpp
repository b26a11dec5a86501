// Modes of a structure with dashpots.
#pragma once

#include <Eigen/Core>

#include "fem/structural_system.hpp"

namespace beamid::fem {

/// The k solutions of (lambda^2 M + lambda C + K) phi = 0 with the smallest |lambda|, ascending. Of a
/// conjugate pair the one with positive imaginary part is kept; an overdamped motion has two real lambdas and
/// is two solutions.
struct ComplexModes {
  Eigen::VectorXcd eigenvalue;  ///< lambda (k) [rad/s]; the motion is Re(a phi e^(lambda t))
  Eigen::MatrixXcd shape;       ///< phi (n x k), phi^H M phi = 1, its largest entry real and positive
  Eigen::VectorXd residual;     ///< ||phi + K^-1 (lambda^2 M + lambda C) phi||_M (k): relative, 0 when exact

  Eigen::Index size() const { return eigenvalue.size(); }
  Eigen::VectorXd frequency_hz() const;         ///< |lambda| / (2 pi)
  Eigen::VectorXd damped_frequency_hz() const;  ///< Im(lambda) / (2 pi); 0 when overdamped
  Eigen::VectorXd damping_ratio() const;        ///< -Re(lambda) / |lambda|; 1 when overdamped
};

/// Eigenvalues 1/lambda of (q, v) -> (-K^-1 (C q + M v), q), the largest ones: Arnoldi (Spectra), dense when
/// the system is small or most modes are wanted. Each pair is then refined (response/complex_pair.hpp) to the
/// digits of stiffness_solver.hpp.
///
/// C is system.damping. A law's own matrix can be added to it first (proportional_damping).
/// @throws std::invalid_argument when count is not in 1..n or the structure can move without strain;
/// std::runtime_error when Arnoldi does not converge or what it found has a residual above 1e-4.
ComplexModes complex_modes(const StructuralSystem& system, Eigen::Index count);

}  // namespace beamid::fem
