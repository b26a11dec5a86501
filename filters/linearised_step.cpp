#include "filters/linearised_step.hpp"

#include "filters/covariance_factor.hpp"
#include "filters/innovation.hpp"

namespace beamid::filters {

using Eigen::MatrixXd;

void LinearisedStep::predict(Gaussian& belief, const MatrixXd& tangent, const MatrixXd& process_noise) {
  steps_.carry(tangent, belief.covariance);
  if (process_noise.size() > 0) belief.covariance += process_noise;
  symmetrise(belief.covariance);
  check_finite(belief);
}

void LinearisedStep::correct(Gaussian& belief, const MatrixXd& sensor, const MatrixXd& noise,
                             Correction& correction) {
  cross_.noalias() = belief.covariance * sensor.transpose();
  correction.innovation_covariance.noalias() = sensor * cross_;
  correction.innovation_covariance += noise;
  gain_ = weigh(correction, cross_, factor_);
  belief.mean.noalias() += gain_ * correction.innovation;
  steps_.reduce(gain_, sensor, noise, belief.covariance);
  check_finite(belief);
}

Gaussian as_matrix(const Gaussian& belief, const DiscreteModel& model) {
  check_belief(belief, model);
  return {belief.mean, with_covariance(belief).covariance};
}

}  // namespace beamid::filters
