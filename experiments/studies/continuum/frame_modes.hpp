// The modes of a plane frame, how far to trust them, and what `beamid frame` prints and writes.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "experiments/config/frame_description.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/progress.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {

/// All (k).
struct FrameModes {
  fem::StructuralSystem system;
  fem::Modes modes;
  /// Relative, |f_h - f_2h| / 3 / f, NaN where not known. The error of stretching falls with h^2, that of
  /// bending with h^4: a mode that only bends errs a fifth of this.
  Eigen::VectorXd discretisation_error;
  /// (phi^T M r)^2 under a motion of the base along x or y, phi^T M phi = 1 [kg]
  Eigen::VectorXd effective_mass_x, effective_mass_y;
  double total_mass = 0.0;         ///< [kg]
  std::vector<std::string> notes;  ///< what a reader should doubt, a sentence each
};

/// @param count of modes, cut to what the mesh has.
/// @throws std::invalid_argument when the frame is impossible; std::runtime_error when its modes are not
/// found.
FrameModes frame_modes(const FrameExperiment& experiment, Eigen::Index count, const Progress& progress);

/// Table modes, results.json with modes[], the figure mode_shapes, and meshes for ParaView.
Results report(const FrameExperiment& experiment, const FrameModes& found);

}  // namespace beamid::experiments
