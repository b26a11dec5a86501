// The motion of a whole beam in time as VTK files, for ParaView.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/results/vtk/beam_grid.hpp"

namespace beamid::fem {
struct Response;
}

namespace beamid::experiments {

/// Writes response.pvd, whose times are in seconds, and one frame_NNNN.vtu for each frame the response
/// stores.
///
/// Point arrays of three components: Displacement [m], Velocity [m/s], Acceleration [m/s2] and Rotation
/// [rad], a rotation vector; relative to the base where that moves. "Warp By Vector" with Displacement draws
/// the motion.
///
/// @param response of picture.system, fields (n x frames).
/// @throws std::invalid_argument when it stores no frames or fields of other sizes. @throws
/// std::runtime_error when a file cannot be written.
void write_field_history(const std::filesystem::path& folder, const Picture& picture,
                         const fem::Response& response);

/// Names of the files that write_field_history writes for so many frames.
std::vector<std::string> field_history_files(Eigen::Index frames);

}  // namespace beamid::experiments
