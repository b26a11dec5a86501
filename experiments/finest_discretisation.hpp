// The discretisation that errs least, for whoever needs the model's own motion and not a filter's.
#pragma once

#include <string>

#include "experiments/joint_model.hpp"

namespace beamid::experiments {

/// Whether the model moves a mesh that nobody has reduced, which is not made into dense matrices.
bool is_whole_mesh(const JointModel& model);

/// The exact one, or, of a whole mesh, the fourth-order one that is banded.
std::string finest_discretisation(const JointModel& model);

}  // namespace beamid::experiments
