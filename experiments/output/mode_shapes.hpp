// Mode shapes of a beam as VTK files, for ParaView.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "fem/structural_system.hpp"

namespace beamid::experiments {

/// Writes modes.vtu, with every mode, and modes.pvd, a series of mode_1.vtu, mode_2.vtu, ... whose time is
/// the frequency [Hz].
///
/// The beam lies along x [m], one line cell per element. A mode is a point array of three components, the
/// deflection in z, scaled so that the largest is 1; in modes.vtu it is called "Mode 1 (4.1455 Hz)", in the
/// series "Mode". "Warp by vector" in ParaView draws it.
///
/// @param system a system of fem::assemble (n coordinates).
/// @param shapes (n x k), one mode per column.
/// @param frequencies_hz (k) [Hz].
/// @throws std::invalid_argument on other sizes. @throws std::runtime_error when a file cannot be written.
void write_mode_shapes(const std::filesystem::path& folder, const fem::StructuralSystem& system,
                       const Eigen::MatrixXd& shapes, const Eigen::VectorXd& frequencies_hz);

/// Names of the files that write_mode_shapes writes for so many modes.
std::vector<std::string> mode_shape_files(Eigen::Index modes);

}  // namespace beamid::experiments
