// Where a model's motion begins when the continuum begins as described.
#pragma once

#include <filesystem>
#include <vector>

#include "experiments/identify/bounds/channel_information.hpp"
#include "experiments/rig/simulated_test.hpp"

namespace beamid::experiments {

inline constexpr Eigen::Index fewest_start_samples = 64;  ///< from which a start is found

/// The continuum as described, seen by these sensors without their noise; behind them in the record what
/// drives it, in the order of the file.
SimulatedTest clean_test(const Experiment& experiment, const std::filesystem::path& folder,
                         const std::vector<Sensor>& sensors, double duration, const Progress& progress);

/// The start from which the model follows best what the continuum does in as many modes as the model has: of
/// further modes a start would make the best of, each set of sensors another. The sensors' offsets are zero.
/// Under the forces that the motion's inputs hold.
/// @param motion all but the start.
/// @param begin first sample that the model follows.
Eigen::VectorXd model_start(const ObservedMotion& motion, Experiment experiment,
                            const std::filesystem::path& folder, const std::vector<Sensor>& sensors,
                            Eigen::Index begin, const Progress& progress);

}  // namespace beamid::experiments
