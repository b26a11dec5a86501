// The Cramer-Rao bound of a run.
#pragma once

#include "experiments/models/joint_model.hpp"
#include "filters/discrete_model.hpp"
#include "filters/measurements.hpp"

namespace beamid::experiments {

/// Deviations of the unknowns [their units] that no unbiased estimate falls below, the start unknown;
/// infinite where the record does not determine them. What is known of nuisance parameters, and of how far a
/// joint has slipped at the start, is information. Samples that were not read are none.
/// @param state of the motion at the first sample (n)
Eigen::VectorXd run_bounds(filters::DiscreteModel& discrete, const JointModel& model,
                           const Eigen::VectorXd& state, const StartDirections& directions,
                           const filters::Measurements& record);

}  // namespace beamid::experiments
