// How a report of modes begins, and the pictures it ends with, whatever the structure.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "experiments/config/experiment.hpp"
#include "experiments/results/results.hpp"
#include "fem/structural_system.hpp"

namespace beamid::experiments {

/// What the pictures show; it outlives what was found.
struct ModeDrawing {
  fem::Structure structure;
  fem::StructuralSystem system;
  Eigen::MatrixXd shapes;          ///< (n x k)
  Eigen::VectorXd frequencies_hz;  ///< (k)
};

/// Configuration, heading and the structure in a sentence. @param modes how many were found
Results begin_modes_report(const Experiment& experiment, Eigen::Index modes, Eigen::Index elements,
                           Eigen::Index coordinates);

/// The figure mode_shapes and meshes for ParaView. @param surface draw the real sections instead of lines
void draw_modes(const std::shared_ptr<const ModeDrawing>& drawn, bool surface, Results& results);

}  // namespace beamid::experiments
