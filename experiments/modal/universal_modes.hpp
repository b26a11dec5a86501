// Mode shapes at points in space as a Universal File, which programs of modal analysis exchange [uff].
#pragma once

#include <Eigen/Core>
#include <complex>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace beamid::experiments {

/// Modes of a structure at its nodes, in space and in SI units. Nodes are numbered from 1 in the order of the
/// columns.
struct NodalModes {
  struct Mode {
    double frequency_hz = 0.0;                     ///< |lambda| / 2 pi
    std::optional<double> damping_ratio = {};      ///< viscous; absent: not known
    std::optional<double> frequency_deviation_hz;  ///< standard deviation; absent: not known
    std::optional<double> modal_mass = {};  ///< phi^T M phi in the shape's scale [kg]; absent: not known
    Eigen::Matrix3Xcd shape;                ///< (3 x nodes) displacements of any scale
  };
  std::string title;                            ///< of the file's lines of identification
  Eigen::Matrix3Xd places;                      ///< (3 x nodes) [m]
  std::vector<std::pair<int, int>> lines = {};  ///< pairs of nodes, from 0
  std::vector<Mode> modes;
  bool complex = false;  ///< shapes have phases: written as complex modes
};

/// Datasets 151 (header), 164 (SI units), 15 (nodes), 82 (lines between them) and one 55 (data at nodes) a
/// mode: of analysis type 2, normal mode, with real displacements, or 3, complex eigenvalue, with lambda =
/// -xi omega +- i omega sqrt(1 - xi^2). Numbers have the six digits of the format's E13.5.
std::string universal_file(const NodalModes& modes);

/// The datasets 55 of normal modes and complex eigenvalues in a file, and the places of their nodes by 15 or
/// 2411 in the file's unit of length (164). Nodes in the order of the first mode. Displacements, velocities
/// and accelerations are displacements afterwards.
/// @throws InputError at the line and column of what does not fit the format, and without any mode.
NodalModes read_universal_modes(const std::filesystem::path& file);

/// Whether a file begins as a Universal File and has a dataset 55. False where it cannot be read.
bool holds_universal_modes(const std::filesystem::path& file);

}  // namespace beamid::experiments
