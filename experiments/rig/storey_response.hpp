// The motion of a chain whose storeys follow laws.
#pragma once

#include "experiments/config/experiment.hpp"
#include "fem/response/response.hpp"

namespace beamid::experiments {

/// As fem::respond(), of the model that an identification uses, by CVODES to 1e-12 a step: inputs run
/// straight between the grid's instants, slips begin at zero.
/// @param system of the chain at these points, whose outputs read displacements
/// @throws std::invalid_argument where the file states a method, or damping that no motion in time has
fem::Response storey_response(const Experiment& experiment, const fem::StructuralSystem& system,
                              const std::vector<fem::Point>& points, const fem::Loading& loading,
                              const fem::TimeGrid& grid);

}  // namespace beamid::experiments
