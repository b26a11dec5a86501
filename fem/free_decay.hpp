// The motion after a release, by exact modal superposition.
#pragma once

#include <Eigen/Core>

#include "fem/modes.hpp"

namespace beamid::fem {

/// History of one point at N instants.
struct Motion {
  Eigen::VectorXd displacement;  ///< (N) [m]
  Eigen::VectorXd velocity;      ///< (N) [m/s]
  Eigen::VectorXd acceleration;  ///< (N) [m/s2]
};

/// Contribution of every mode to one output of a motion that starts from rest at q_0:
/// (H phi_i)(phi_i^T M q_0) (k) [m].
Eigen::VectorXd modal_amplitudes(const StructuralSystem& system, const Modes& modes,
                                 const Eigen::VectorXd& initial_displacement, Eigen::Index output = 0);

/// Sum of freely decaying modes, each started from rest: with omega_d = omega sqrt(1 - xi^2),
///
///     a e^(-xi omega t) (cos omega_d t + xi omega / omega_d sin omega_d t)
///
/// and its exact first and second derivative, without time stepping.
/// @param amplitude a (k) [m], @param angular_frequency omega (k) [rad/s], @param damping_ratio xi (k) in [0,
/// 1)
/// @param time (N) [s], from the release
/// @throws std::invalid_argument when sizes differ or a damping ratio is outside [0, 1).
Motion free_decay(const Eigen::VectorXd& amplitude, const Eigen::VectorXd& angular_frequency,
                  const Eigen::VectorXd& damping_ratio, const Eigen::VectorXd& time);

}  // namespace beamid::fem
