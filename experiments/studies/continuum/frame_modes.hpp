// The modes of a plane frame or a space frame, how far to trust them, and what `beamid frame` and `beamid
// modes` print and write.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/progress.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {

/// All (k).
struct FrameModes {
  fem::StructuralSystem system;
  fem::Modes modes;
  /// Relative, NaN where not known: |f_h - f_2h| / 10.3 / f, whose 10.3 would be 15 for an error of h^4; / 3
  /// with lumped mass, which errs by h^2, and of modes that the coarser mesh does not resolve.
  Eigen::VectorXd discretisation_error;
  std::string axes;  ///< along which it moves, "xy" or "xyz"
  Eigen::MatrixXd
      effective_mass;       ///< (k x axes) (phi^T M r)^2 under a motion of the base, phi^T M phi = 1 [kg]
  double total_mass = 0.0;  ///< [kg]
  std::vector<std::string> notes;  ///< what speaks against them, a sentence each
};

/// @param count of modes, cut to what the mesh has.
/// @throws std::invalid_argument when the frame is impossible; std::runtime_error when its modes are not
/// found.
FrameModes frame_modes(const fem::Structure& frame, int elements_per_member, Eigen::Index count,
                       const Progress& progress);

/// Table modes, results.json with modes[], the figure mode_shapes, and meshes for ParaView.
/// @param surface draw the real sections of a space frame instead of lines
Results report(const Experiment& experiment, const FrameModes& found, bool surface);

}  // namespace beamid::experiments
