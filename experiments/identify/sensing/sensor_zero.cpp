#include "experiments/identify/sensing/sensor_zero.hpp"

#include <cmath>

#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// The smoother is linear in the readings, and its gains do not depend on them: what it makes of a constant
// beside nothing is what a zero that is off adds.
std::vector<SoleZero> sole_zeros(const SensingModel& model, const VectorXd& theta,
                                 const filters::LinearGaussian& form, const filters::KalmanPass& pass,
                                 const std::vector<Channel>& channels, const MatrixXd& rows,
                                 const MatrixXd& feed) {
  std::vector<SoleZero> found;
  filters::LinearGaussian still = form;
  still.start.mean.setZero();
  for (const Index i : model.sole_zeros(theta)) {
    const Channel& channel = channels[static_cast<std::size_t>(i)];
    const double read = root_mean_squares(model.record().outputs.row(i))[0];
    if (!(read > 0.0)) continue;
    SoleZero zero{channel.name, si_unit(channel.quantity), std::pow(10.0, std::floor(std::log10(read))), {}};
    filters::Measurements shifted = model.record();
    shifted.inputs.setZero();
    for (auto& reading : shifted.outputs.reshaped())
      if (std::isfinite(reading)) reading = 0.0;
    shifted.outputs.row(i).array() += zero.off;
    const filters::KalmanPass of_shifted = filters::kalman_pass(still, shifted, pass);
    const VectorXd means = filters::smoothed_means(still, shifted, of_shifted, rows, feed).rowwise().mean();
    zero.shifts.assign(means.begin(), means.end());
    found.push_back(std::move(zero));
  }
  return found;
}

}  // namespace beamid::experiments
