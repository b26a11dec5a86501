// Sets of parameters with the same modes, as a user sees them.
#pragma once

#include "experiments/studies/update/report.hpp"

namespace beamid::experiments {

/// The sets first, then how complete they are and what would decide.
Results twins_report(const Experiment& experiment, const UpdateStudy& study);

}  // namespace beamid::experiments
