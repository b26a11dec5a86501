// Other causes that could have made C wrong, one at a time, before an exact filter.
#pragma once

#include <string>
#include <vector>

#include "experiments/results/table.hpp"
#include "experiments/studies/paper/beam_identification.hpp"

namespace beamid::experiments::paper {

/// What the exact filter makes of the five beams when one thing is done wrong to a clean first mode.
struct AlternativeCase {
  std::string name;
  Eigen::VectorXd damping_error_percent;        ///< without process noise (5)
  Eigen::VectorXd noisy_damping_error_percent;  ///< Q of the motion 1e-8 per step (5)
  Eigen::VectorXd stiffness_error_percent;      ///< without process noise (5)
};

inline constexpr double alternative_process_variance = 1e-8;

/// @param beams the five
std::vector<AlternativeCase> examine_alternatives(const std::vector<const BeamCase*>& beams);

Table alternative_table(const std::vector<AlternativeCase>& cases);

}  // namespace beamid::experiments::paper
