// Modes of the continuum itself, without a mesh: the oracle of the finite elements.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "fem/beam.hpp"

namespace beamid::fem {

/// Undamped modes of the continuum.
struct ExactModes {
  Eigen::VectorXd angular_frequency;  ///< omega (k) [rad/s], ascending, rigid-body modes first with exactly 0
  Eigen::MatrixXd deflection;         ///< w (positions x k), largest value of each mode 1
};

/// Lowest `count` undamped modes of a beam of uniform pieces, Euler-Bernoulli or Timoshenko, with rotary
/// inertia, axial load, bodies, springs, absorbers, supports, damage and added mass; to rounding, however
/// high the mode.
///
/// The state (w, theta, V, M) of a piece is exp(A x) times that at its begin; the frequencies are where the
/// states that one end admits contain one that the other admits. They are found by bisection on the number of
/// frequencies below a trial value [wittrick1971], so that none is missed (exact_modes.cpp). Forces of
/// springs and dashpots that are not linear elastic are left out; the mass model, which refers to a mesh, is
/// ignored.
///
/// @param positions where deflections are wanted [m]
/// @return nothing where no exact solution is known: a section that varies along its segment, or a
/// compression above two fifths of the shear stiffness.
/// @throws std::invalid_argument when the beam is impossible, count < 1 or a position is off the beam;
/// std::runtime_error when an axial load has buckled the beam.
std::optional<ExactModes> exact_modes(const Beam& beam, Eigen::Index count, const Eigen::VectorXd& positions);

}  // namespace beamid::fem
