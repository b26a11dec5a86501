// Records of a free decay as a data generator of 2009 might have made them: exact, or by a time step of its
// own.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "experiments/models/oscillator.hpp"

namespace beamid::experiments::paper {

/// The generators compared: exact motion, three of Newmark's family [newmark1959], and the one-step schemes.
const std::vector<std::string>& data_generators();

/// Displacement and velocity (2 x samples) of an oscillator released from rest, the first sample one interval
/// after the release.
/// @param generator "exact"; "average_acceleration", "linear_acceleration" or "central_difference", Newmark's
///   beta = 1/4, 1/6 or 0; or the name of a registered scheme.
/// @throws std::invalid_argument for another name.
Eigen::MatrixXd generate_decay(const std::string& generator, const Oscillator& truth, double release,
                               double interval, Eigen::Index samples);

}  // namespace beamid::experiments::paper
