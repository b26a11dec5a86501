// The modes of a simulation that its record can show.
#pragma once

#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "fem/response/response.hpp"
#include "fem/structural_system.hpp"

namespace beamid::experiments {

/// The method as set. The modal one gets as many modes as the record can show, those below half the sampling
/// rate and 200 at most, unless the file says how many; a note says what the others show.
fem::ResponseMethod audible_method(const Simulation& settings, const fem::StructuralSystem& system,
                                   std::vector<std::string>& notes);

}  // namespace beamid::experiments
