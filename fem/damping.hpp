// Laws that give every mode its damping, beside the dashpots of the model itself.
#pragma once

#include <Eigen/Core>
#include <variant>
#include <vector>

#include "fem/structural_system.hpp"

namespace beamid::fem {

struct Undamped {};

/// xi_i of mode i; modes beyond the last entry get the last one.
struct ModalDamping {
  std::vector<double> ratios;  ///< at least one [-]
};

/// A frequency at which the damping ratio is known.
struct DampingAnchor {
  double frequency_hz = 0.0;
  double ratio = 0.0;
};

/// C = alpha M + beta K, hence xi(omega) = (alpha / omega + beta omega) / 2 [rayleigh1877].
struct RayleighDamping {
  DampingAnchor first, second;
};

/// C = M sum_j a_j (M^-1 K)^j, hence xi(omega) = 1/2 sum_j a_j omega^(2j-1), j = 0..k-1, through k anchors
/// [caughey1960]. One anchor is damping proportional to the mass, two are Rayleigh's.
struct CaugheyDamping {
  std::vector<DampingAnchor> anchors;  ///< at least one
};

/// Hysteretic, K (1 + i eta): harmonic motion only, for in time it would answer before it is asked
/// [crandall1970].
struct StructuralDamping {
  double loss_factor = 0.0;  ///< eta [-]
};

using DampingLaw = std::variant<Undamped, ModalDamping, RayleighDamping, CaugheyDamping, StructuralDamping>;

/// The law's name: undamped, modal, rayleigh, caughey or structural.
const char* name(const DampingLaw& law);

/// xi (k) that the law gives modes of these frequencies, in their order; eta / 2, what a hysteretic structure
/// shows at resonance, for structural damping. NaN where the frequency is zero: a rigid-body motion has no
/// critical damping.
/// @param angular_frequency omega (k) [rad/s], of modes 1 to k
/// @throws std::invalid_argument when the law is impossible (ratios missing, negative or not finite, anchors
/// at frequencies not positive or equal) or gives one of these modes a negative ratio, naming the mode.
Eigen::VectorXd damping_ratios(const DampingLaw& law, const Eigen::VectorXd& angular_frequency);

/// d = 2 xi omega (k) [1/s] of z'' + d z' + omega^2 z = 0, finite for rigid-body motions too.
/// @throws as damping_ratios; for structural damping always.
Eigen::VectorXd damping_rates(const DampingLaw& law, const Eigen::VectorXd& angular_frequency);

/// What a damping matrix that keeps the sparsity of M and K is made of, C = alpha M + beta K.
struct ProportionalDamping {
  double mass = 0.0;       ///< alpha [1/s]
  double stiffness = 0.0;  ///< beta [s]
};

/// alpha and beta of Rayleigh's law, of Caughey's with at most two anchors, and of no damping.
/// @throws std::invalid_argument for the others, whose matrices are full or none, saying what to use instead.
ProportionalDamping proportional_coefficients(const DampingLaw& law);

/// The matrix itself (n x n) [N s/m]. @throws as proportional_coefficients.
SparseMatrix proportional_damping(const DampingLaw& law, const StructuralSystem& system);

}  // namespace beamid::fem
