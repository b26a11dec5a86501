// Natural frequencies and mode shapes.
#pragma once

#include <Eigen/Core>

#include "fem/structural_system.hpp"

namespace beamid::fem {

/// The k lowest solutions of K phi = omega^2 M phi, frequencies ascending.
struct Modes {
  Eigen::VectorXd angular_frequency;  ///< omega (k) [rad/s], from the strain-form Rayleigh quotient
  Eigen::MatrixXd shape;              ///< phi (n x k), phi^T M phi = 1
  Eigen::VectorXd residual;           ///< ||phi - omega^2 K^-1 M phi||_M (k): relative, 0 when exact

  Eigen::Index size() const { return angular_frequency.size(); }
  Eigen::VectorXd frequency_hz() const;
};

/// Lowest `count` modes (all of them at most). Few modes of a large system: shift-invert Lanczos at shift
/// zero (Spectra) on the factored stiffness. Most modes, or a small system: singular values of D^1/2 B
/// M^-1/2, which are the frequencies themselves and not their squares.
/// @throws std::invalid_argument when count is not in 1..n; std::runtime_error when Lanczos does not converge
/// or what it found has a residual above 1e-4.
Modes modes(const StructuralSystem& system, Eigen::Index count);

}  // namespace beamid::fem
