// What one record at several steps shows, for a person and for programs.
#pragma once

#include "experiments/config/channel_places.hpp"
#include "experiments/results/results.hpp"
#include "experiments/studies/steps/steps.hpp"

namespace beamid::experiments {

/// Its first lines say how wrong a filter of each discretisation is on this record. Tables `steps` and
/// `extrapolation`, figure `step_size`, results.json keys.
Results report(const Experiment& experiment, const StepsStudy& study);

/// Damping ratio and frequency found, on the curves that the closed form predicts.
Figure steps_figure(const StepsStudy& study);

}  // namespace beamid::experiments
