// The lowest modes of any structure, as `beamid modes` reports them.
#pragma once

#include <Eigen/Core>

#include "experiments/config/channel_places.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

/// @param count of modes, cut to what the mesh has. @param surface draw the real sections for ParaView
/// @throws std::invalid_argument when the structure is impossible; std::runtime_error when its modes are not
/// found.
Results modes_study(const Experiment& experiment, Eigen::Index count, bool surface, const Progress& progress);

}  // namespace beamid::experiments
