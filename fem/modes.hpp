// Natural frequencies and mode shapes.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "fem/parametric_system.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {

/// The k lowest solutions of K phi = omega^2 M phi, frequencies ascending, rigid-body modes first.
///
/// What an eigensolver finds, psi with psi^T M psi = 1, goes through one inverse iteration K q = M psi. Its
/// residual says how good psi was; phi is q, scaled, and better still. Modes so high that the iteration would
/// rather bring out the lower ones, with residuals above 1e-6, keep psi.
struct Modes {
  /// omega (k) [rad/s], from the complementary energy of the natural forces N that belong to q,
  /// omega^2 = N^T D^-1 N / (q^T M q), where nothing cancels; the strain-form quotient for modes that keep
  /// psi. Zero for rigid-body modes, exactly.
  Eigen::VectorXd angular_frequency;
  Eigen::MatrixXd shape;     ///< phi (n x k), phi^T M phi = 1
  Eigen::VectorXd residual;  ///< ||psi - omega^2 K^-1 M psi||_M (k): relative, 0 when exact; psi: see below

  /// (k) [rad/s], from the strain-form Rayleigh quotient (B phi)^T D (B phi) of the shape [rayleigh1877].
  Eigen::VectorXd rayleigh_angular_frequency;
  Eigen::Index rigid = 0;  ///< the first so many are rigid-body modes

  Eigen::Index size() const { return angular_frequency.size(); }
  Eigen::VectorXd frequency_hz() const;

  /// Decimal digits of frequency i on which the two forms agree, 0 to 15.
  double digits(Eigen::Index i) const;
};

/// Lowest `count` modes (all of them at most). Rigid-body motions are found from the strains and set apart.
/// Of the rest, few modes of a large system: shift-invert Lanczos at shift zero (rigid_complement.hpp). Most
/// modes, or a small system: dense (modes.cpp).
/// @throws std::invalid_argument when count is not in 1..n; std::runtime_error when Lanczos does not converge
/// or what it found has a residual above 1e-4, when a mode has a negative omega^2 (an axial load beyond
/// buckling), when fewer than `count` modes have mass.
Modes modes(const StructuralSystem& system, Eigen::Index count);

/// Of the lowest mode that is no rigid-body motion [Hz]; 0 where there is none. @throws as modes()
double lowest_frequency_hz(const StructuralSystem& system);

// How natural frequencies and mode shapes move with a beam's parameters.

/// One mode near p_0, to the second order in x = p - p_0:
///
///     omega^2(p) = square + slope . x + x . curvature x / 2,      likewise every reading h phi(p)
///
/// for phi^T M(p) phi = 1 at every p.
struct ModeCurve {
  double square = 0.0;               ///< omega^2 [rad2/s2]
  Eigen::VectorXd square_slope;      ///< (q)
  Eigen::MatrixXd square_curvature;  ///< (q x q)

  Eigen::VectorXd reading;                         ///< H phi (p)
  Eigen::MatrixXd reading_slope;                   ///< (p x q)
  std::vector<Eigen::MatrixXd> reading_curvature;  ///< of reading i (q x q)
};

/// The curves of these modes. With F = K - omega^2 M and its derivatives F_j = K_j - (omega^2)_j M -
/// omega^2 M_j, the shapes' come from [nelson1976]
///
///     F phi_j = -F_j phi,      phi^T M phi_j = -phi^T M_j phi / 2
///
/// as one bordered system per mode, which is regular where F is not; the second derivatives from the same
/// system again.
/// @param modes of equations.system, none of them rigid, frequencies distinct
/// @throws std::invalid_argument when there is a rigid mode. @throws std::runtime_error when two modes share
/// a frequency.
std::vector<ModeCurve> mode_curves(const ParametricSystem& equations, const Modes& modes);

}  // namespace beamid::fem
