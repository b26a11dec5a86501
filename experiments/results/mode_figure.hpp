// Mode shapes as a figure for a paper.
#pragma once

#include <Eigen/Core>
#include <utility>

#include "experiments/results/figure.hpp"
#include "experiments/results/page/swing_model.hpp"
#include "experiments/results/vtk/beam_grid.hpp"
#include "fem/structural_system.hpp"

namespace beamid::experiments {

/// Most modes in one figure.
inline constexpr Eigen::Index most_drawn_modes = 12;

/// The figure "mode_shapes": one panel for each of the first 12 modes, entitled "mode 1, 4.1455 Hz", with the
/// undeformed structure as a thin line.
///
/// A beam's deflection, largest 1, is drawn over its length; a frame in its own plane, moved by an eighth of
/// its size. Between nodes the curve is the cubic of their deflections and rotations.
///
/// @param system a system of fem::assemble (n coordinates).
/// @param shapes (n x k), one mode per column.
/// @param frequencies_hz (k) [Hz]; 0: a rigid-body mode.
/// @throws std::invalid_argument on other sizes, without any mode, and when the system has no mesh.
Figure mode_figure(const fem::StructuralSystem& system, const Eigen::MatrixXd& shapes,
                   const Eigen::VectorXd& frequencies_hz);

/// The same modes as a model that swings, with the bodies as cubes of steel and, where they take no more than
/// 4000 triangles, the sections drawn to scale (vtk/beam_grid.hpp).
///
/// @param picture of a system of fem::assemble, with its structure where bodies and sections are to be drawn.
/// @throws std::invalid_argument as mode_figure().
SwingModel mode_model(const Picture& picture, const Eigen::MatrixXd& shapes,
                      const Eigen::VectorXd& frequencies_hz);

/// A motion in time as such a model, by at most 12 shapes of its own: the singular vectors of `displacement`,
/// as many as hold it to 0.1 % (root mean square).
///
/// @param time (samples) [s]. @param displacement q of the picture's system (n x samples).
/// @throws std::invalid_argument on other sizes, and without a mesh.
std::pair<SwingModel, MotionHistory> motion_model(const Picture& picture, const Eigen::VectorXd& time,
                                                  const Eigen::MatrixXd& displacement);

/// A beam's mode shape (n) along x, smooth between the nodes, largest deflection 1.
Curve mode_curve(const fem::StructuralSystem& system, const Eigen::VectorXd& shape);

}  // namespace beamid::experiments
