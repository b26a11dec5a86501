// What rests on the zero of one sensor.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/sensing/sensing_model.hpp"

namespace beamid::experiments {

/// A sensor whose constant offset no other can tell from a constant force: its zero is taken for exact, and
/// no deviation of a history holds what it is off.
struct SoleZero {
  std::string name, unit;
  double off = 0.0;            ///< a power of ten, below what the sensor reads
  std::vector<double> shifts;  ///< mean of every history over the record where the zero is off by that
};

/// @param pass of the record through the filter; @param rows, feed of the histories, as for smoothed_rows
std::vector<SoleZero> sole_zeros(const SensingModel& model, const Eigen::VectorXd& theta,
                                 const filters::LinearGaussian& form, const filters::KalmanPass& pass,
                                 const std::vector<Channel>& channels, const Eigen::MatrixXd& rows,
                                 const Eigen::MatrixXd& feed);

}  // namespace beamid::experiments
