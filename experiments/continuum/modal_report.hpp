// What `beamid modes` prints and writes.
#pragma once

#include "experiments/continuum/modal_summary.hpp"
#include "experiments/output/results.hpp"

namespace beamid::experiments {

/// Tables modes and complex_modes, results.json with modes[], the figure mode_shapes, and meshes for
/// ParaView.
/// @param surface draw the real sections instead of a line.
Results report(const Experiment& experiment, const ModalSummary& summary, bool surface);

}  // namespace beamid::experiments
