// Files that ParaView opens: one grid with its arrays, and a series of them in time.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "experiments/results/vtk/beam_grid.hpp"

namespace beamid::experiments {

/// Vectors at the points of a grid (3 x points).
struct PointArray {
  std::string name;
  Eigen::Matrix3Xd values;
};

/// Writes an unstructured grid with its arrays at the points, and for every cell Section, Element,
/// BendingStiffness, Damage and Mass (BeamGrid::Cell). All doubles keep every digit.
///
/// What VTK does for it is in a library of its own, libbeamid_vtk.so. It is looked for as
/// lib/beamid/vtk/libbeamid_vtk.so in every folder above the calling program or module, then in /usr/local
/// and /usr, then where the system looks for libraries.
/// @throws NotDrawn (drawing.hpp) when that library is missing or of another version.
/// @throws std::runtime_error when the file cannot be written.
void write_vtu(const std::filesystem::path& file, const BeamGrid& grid,
               const std::vector<PointArray>& arrays);

/// Writes a series: the time of each step and the name of its file.
/// @throws std::runtime_error when the file cannot be written.
void write_pvd(const std::filesystem::path& file, const std::vector<std::pair<double, std::string>>& steps);

}  // namespace beamid::experiments
