#include "filters/linearised_step.hpp"

#include "filters/covariance_factor.hpp"
#include "filters/innovation.hpp"

namespace beamid::filters {

using Eigen::MatrixXd;

void LinearisedStep::predict(Gaussian& estimate, const MatrixXd& tangent, const MatrixXd& process_noise) {
  steps_.carry(tangent, estimate.covariance);
  if (process_noise.size() > 0) estimate.covariance += process_noise;
  symmetrise(estimate.covariance);
  check_finite(estimate);
}

void LinearisedStep::correct(Gaussian& estimate, const MatrixXd& sensor, const MatrixXd& noise,
                             Correction& correction) {
  cross_.noalias() = estimate.covariance * sensor.transpose();
  correction.innovation_covariance.noalias() = sensor * cross_;
  correction.innovation_covariance += noise;
  gain_ = weigh(correction, cross_, factor_);
  estimate.mean.noalias() += gain_ * correction.innovation;
  steps_.reduce(gain_, sensor, noise, estimate.covariance);
  check_finite(estimate);
}

Gaussian as_matrix(const Gaussian& estimate, const DiscreteModel& model) {
  check_estimate(estimate, model);
  return {estimate.mean, with_covariance(estimate).covariance};
}

}  // namespace beamid::filters
