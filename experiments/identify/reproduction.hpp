// The motion that a model with given parameters makes of a record: its best start, and what it leaves.
#pragma once

#include "experiments/models/initial_estimate.hpp"
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

}  // namespace beamid::experiments
