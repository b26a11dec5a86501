// The discretisation that errs least, for whoever needs the model's own motion and not a filter's.
#pragma once

#include <string>

#include "experiments/models/joint_model.hpp"

namespace beamid::experiments {

/// Whether the model moves a mesh that nobody has reduced, which is not made into dense matrices.
bool is_whole_mesh(const JointModel& model);

/// Whether the model's outputs are no linear function of its start, its parameters given.
bool is_nonlinear(const JointModel& model);

/// Whether it is a chain whose storeys follow laws (storeys.hpp).
bool has_storey_laws(const JointModel& model);

/// The exact one; of a whole mesh the fourth-order one that is banded; of nonlinear motion the classical
/// Runge-Kutta step where an interval is short for it, as that of storeys always is (storey_step.hpp), else
/// CVODES.
/// @param interval [s]; 0: so short that any fourth-order step will do
std::string finest_discretisation(const JointModel& model, double interval = 0.0);

}  // namespace beamid::experiments
