// Frequencies and shapes that were measured, whoever found them.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace beamid::experiments {

/// A mode that was measured.
struct MeasuredMode {
  double frequency_hz = 0.0, deviation_hz = 0.0;  ///< deviation: standard deviation, zero where unknown
  Eigen::VectorXd shape = {};                     ///< (p) displacements of any scale; empty: not measured
  double shape_deviation = 0.0;                   ///< of each component, in the shape's scale; zero: unknown
  std::optional<int> number = {};                 ///< of the mode, from 1; absent: to be found out
};

/// Modes of one structure, frequencies ascending.
struct ModalData {
  std::string source;  ///< the file, for messages
  std::vector<MeasuredMode> modes;
  std::vector<std::string> remarks = {};     ///< what was decided in reading, sentences
  std::vector<std::string> objections = {};  ///< of the analysis that found them, sentences

  bool has_shapes() const {
    return std::ranges::any_of(modes, [](const MeasuredMode& mode) { return mode.shape.size() > 1; });
  }
};

}  // namespace beamid::experiments
