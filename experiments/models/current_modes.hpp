// Modes of a joint model where its unknowns are now.
#pragma once

#include "experiments/models/joint_model.hpp"

namespace beamid::experiments {

/// The model with the modes that it has at a state's unknowns (n) in place of those at the guesses. Of a mesh
/// that nobody has reduced they stay as they are.
/// @throws std::runtime_error when the model does not oscillate there in as many modes.
JointModel with_modes_at(JointModel model, const Eigen::VectorXd& state);

/// d[z, z']/d eta_j of a motion z = Phi a, z' = Phi b in the modes Phi(eta) of the model (n x q; zero below
/// the motion), by central differences of Phi.
///
/// Modes that a record does not hold stay at rest only when the start follows the modes. A start that is held
/// while the unknowns change excites the higher ones, in acceleration by (omega_i / omega_1)^2 times as much,
/// and a fit would rather keep the unknowns.
/// @param model its modes are those at the state (with_modes_at)
/// @returns zeros for a mesh that nobody has reduced
Eigen::MatrixXd motion_slopes(const JointModel& model, const Eigen::VectorXd& state);

}  // namespace beamid::experiments
