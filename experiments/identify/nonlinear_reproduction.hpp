// The motion that a nonlinear model with given parameters makes of a record.
#pragma once

#include "experiments/identify/reproduction.hpp"

namespace beamid::experiments {

/// A start in the model's first mode, of the size that the directions tell, whose motion is nearest to the
/// beginning of the record: all phases of one cycle and two sizes are tried, and rest.
/// @param state parameters to move with, in their places (n)
/// @param samples of the record that count
Eigen::VectorXd nearest_phase(filters::DiscreteModel& discrete, const Eigen::VectorXd& state,
                              const StartDirections& directions, const filters::Measurements& record,
                              Eigen::Index samples);

/// Samples in so many periods of the model's first mode, at least 16 and at most all.
Eigen::Index samples_in(const JointModel& model, const filters::Measurements& record, double periods);

/// reproduce() where the outputs are no linear function of the start: Gauss-Newton with exact tangents,
/// damped where a step would not help (filters::estimate_batch), from the motion in `state`, or, where that
/// is at rest, from the nearest phase through parts of the record that double in length.
/// @throws std::runtime_error when no motion can be followed
Reproduction reproduce_nonlinear(const JointModel& model, filters::DiscreteModel& discrete,
                                 const Eigen::VectorXd& state, const StartDirections& directions,
                                 const filters::Measurements& record);

}  // namespace beamid::experiments
