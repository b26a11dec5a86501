// What a parameter is in truth, where the record was simulated.
#pragma once

#include <optional>

#include "experiments/experiment.hpp"
#include "experiments/joint_model.hpp"

namespace beamid::experiments {

/// Of unknown j of the model. Properties of the beam are those of the beam simulated; a region's bending
/// stiffness is its mean there, damage included. K and C of one degree of freedom are those of the beam's
/// exact first mode with the model's own mass, M omega_1^2 and 2 xi_1 omega_1 M, so that an error of the mass
/// is not counted as one of the filter; an unknown mass is the modal mass at the first output.
/// @returns nothing where the beam simulated has no such quantity.
std::optional<double> true_value(const Experiment& truth, const JointModel& model, std::size_t j);

}  // namespace beamid::experiments
