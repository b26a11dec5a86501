// The motion that a model with given parameters makes of a record: its best start, and what it leaves.
#pragma once

#include "experiments/models/joint_model.hpp"
#include "filters/discrete_model.hpp"
#include "filters/filter_run.hpp"

namespace beamid::experiments {

/// Of all motions of the model that start in the start directions, the one nearest to the record in the
/// noise's norm. The outputs are linear in the start while the parameters stay, so it is a linear least
/// squares problem, solved by QR.
struct Reproduction {
  Eigen::VectorXd initial_state;        ///< (n) at the first sample, the parameters included
  Eigen::MatrixXd outputs;              ///< (p x N)
  Eigen::VectorXd residual_deviation;   ///< root mean square of what is left, per channel (p)
  double response_error_percent = 0.0;  ///< 100 ||y - outputs|| / ||y||, channels weighed by their size
  /// Likewise, of channels whose rest is not white the part that is correlated: what noise does not explain.
  double misfit_percent = 0.0;
};

/// What the outputs leave of the samples that were read.
void take_misfit(const filters::Measurements& record, Reproduction& motion);

/// @param state parameters to move with, in their places (n); its motion and offsets are not looked at.
/// Stamps may be uneven; outputs that are NaN were not read. R is diagonal.
/// @throws std::runtime_error when the motion does not stay finite.
Reproduction reproduce(filters::DiscreteModel& model, const Eigen::VectorXd& state,
                       const StartDirections& directions, const filters::Measurements& record);

// The motion that a nonlinear model with given parameters makes of a record.

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
