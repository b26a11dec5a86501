// What `beamid modes` prints and writes.
#pragma once

#include "experiments/results/results.hpp"
#include "experiments/studies/continuum/modal_summary.hpp"

namespace beamid::experiments {

/// Tables modes and complex_modes, results.json with modes[], the figure mode_shapes, and meshes for
/// ParaView.
/// @param surface draw the real sections instead of a line.
Results report(const Experiment& experiment, const ModalSummary& summary, bool surface);

}  // namespace beamid::experiments
