// Mode shapes of a beam as VTK files, for ParaView.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/results/vtk/beam_grid.hpp"

namespace beamid::experiments {

/// Writes modes.vtu, with every mode, and modes.pvd, a series of mode_1.vtu, mode_2.vtu, ... whose time is
/// the frequency [Hz].
///
/// A mode is a point array of three components, scaled so that the largest displacement of the axis is 1, and
/// an array of its rotation vectors [rad per that 1]. In modes.vtu they are called "Mode 1 (4.1455 Hz)" and
/// "Mode 1 (4.1455 Hz) rotation", in the series "Mode" and "Rotation". "Warp By Vector" in ParaView draws it.
///
/// Times must differ, or ParaView shows two modes at once: a frequency not above the one before, such as that
/// of the second rigid-body mode, is written 1e-9 of the highest frequency above it.
///
/// @param picture a system of fem::assemble (n coordinates), or with its beam (beam_grid.hpp).
/// @param shapes (n x k), one mode per column.
/// @param frequencies_hz (k) [Hz].
/// @throws std::invalid_argument on other sizes. @throws std::runtime_error when a file cannot be written.
void write_mode_shapes(const std::filesystem::path& folder, const Picture& picture,
                       const Eigen::MatrixXd& shapes, const Eigen::VectorXd& frequencies_hz);

/// Names of the files that write_mode_shapes writes for so many modes.
std::vector<std::string> mode_shape_files(Eigen::Index modes);

}  // namespace beamid::experiments
