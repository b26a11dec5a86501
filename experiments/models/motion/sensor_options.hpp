// What models of several observations have in common: which sensors there are and what is unknown of them.
#pragma once

#include <string>
#include <vector>

#include "experiments/models/motion/parametric_motion.hpp"
#include "filters/options.hpp"

namespace beamid::experiments {

/// sensor_bias and sensor_drift.
std::vector<filters::OptionSpec> sensor_options();

/// Share of the base's acceleration that each output shows (p).
Eigen::VectorXd base_shares(const fem::StructuralSystem& system);

/// Observations, forces and sensors' offsets.
/// @throws std::invalid_argument when nothing is observed, a force is, an input does not exist, or there is a
/// drift without a bias.
MotionDescription describe_sensors(const std::string& model, const ModelSetting& setting,
                                   const filters::Options& options);

}  // namespace beamid::experiments
