// Damping of the beam model: what the described law gives and what the record is asked about.
#pragma once

#include <vector>

#include "experiments/models/motion/parametric_motion.hpp"
#include "fem/damping.hpp"

namespace beamid::experiments {

/// What is assumed of damping choices beforehand: the law's ratio of the mode, or of the first one for all
/// modes together, 1 % where no damping is described; alpha and beta of Rayleigh's law, else 0; all of them
/// to as much again. Other choices are left alone.
/// @param frequencies omega of the modes that are damped, ascending [rad/s]
/// @throws std::invalid_argument, or an InputError at a choice's place, when there is no such mode.
void add_damping_defaults(const fem::DampingLaw& law, const Eigen::VectorXd& frequencies,
                          const std::vector<ParameterChoice>& choices,
                          std::vector<ParameterDefault>& defaults);

/// Fills in damped modes, alpha and beta. Laws that are alpha M + beta K stay so where no damping ratio is
/// asked about; otherwise, and for the other laws, every mode has the ratio that the law gives it.
/// @param modes the damping of each mode, ratio and unknown still open
void describe_damping(const fem::DampingLaw& law, const Eigen::VectorXd& frequencies,
                      std::vector<DampedMode> modes, MotionDescription& description);

}  // namespace beamid::experiments
