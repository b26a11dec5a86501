// Histories as they may have been, and the damage that they do.
#pragma once

#include "experiments/identify/sensing/sensing.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {

/// One history of the rows C x_k + D u_k given the record (c x N): a record drawn from the model, what the
/// smoother makes of the difference from it, and its own motion [durbin2002].
/// @param pass of the record through the filter
Eigen::MatrixXd drawn_rows(const SensingModel& model, const filters::LinearGaussian& form,
                           const filters::KalmanPass& pass, const Eigen::MatrixXd& rows,
                           const Eigen::MatrixXd& feed, filters::RandomStream& random);

/// Of every virtual strain: damage of the drawn histories, their mean and where 95 % of them lie. The
/// smoothed history itself varies less than the motion did, and damages less.
void add_damages(const Experiment& experiment, const SensingModel& model, const filters::LinearGaussian& form,
                 const filters::KalmanPass& pass, const Eigen::MatrixXd& rows, const Eigen::MatrixXd& feed,
                 SensingStudy& study);

}  // namespace beamid::experiments
