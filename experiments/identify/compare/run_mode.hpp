// The lowest mode of a record in a model at its estimate.
#pragma once

#include <optional>

#include "experiments/models/divergence.hpp"
#include "experiments/models/joint_model.hpp"

namespace beamid::experiments {

/// The slowest oscillation of the equations of motion at a state that the measured inputs reach and the
/// sensors see: of a tower shaken along x not its mode along y. Absent: nothing oscillates.
/// @param unknowns their estimate and covariance as the state carries them (q): deviations to first order
std::optional<FoundMode> lowest_mode(const JointModel& model, const Eigen::VectorXd& state,
                                     const filters::Gaussian& unknowns);

}  // namespace beamid::experiments
