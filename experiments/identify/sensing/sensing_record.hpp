// What of a record is read, and what of it serves as a check, where forces are taken for unknown.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

struct SensingRecord {
  /// Measured outputs first, then the virtual sensors as channels that were never read (NaN), then measured
  /// inputs, then the unknown forces (zeros).
  Record record;
  Eigen::Index measured = 0;  ///< outputs that were read
  /// What the virtual sensors would have read, and the forces were, where that is known: of a simulated
  /// record, or a force that was measured and is taken for unknown. Empty: not known.
  std::vector<Eigen::VectorXd> sensors, forces;
};

/// @throws InputError where no output is left.
SensingRecord sensing_record(const Experiment& experiment, const Record& record, const Place& place);

/// The experiment's own test, simulated, with what the virtual sensors would read without noise.
SensingRecord simulated_sensing(const Experiment& experiment, const std::filesystem::path& folder,
                                const Place& place, const Progress& progress);

}  // namespace beamid::experiments
