#include "experiments/identify/engine/batch.hpp"

namespace beamid::experiments {

BatchIdentification identify_batch(const JointModel& model, const IdentificationSettings& settings,
                                   const Eigen::VectorXd& start, const Eigen::MatrixXd& directions,
                                   const filters::Measurements& measured) {
  const auto discrete = filters::discretise(model.motion, measured.interval(), settings.discretisation,
                                            {{}, settings.output_noise});
  BatchIdentification result;
  result.estimate = filters::estimate_batch(*discrete, start, directions, measured);
  const filters::BatchEstimate& estimate = result.estimate;
  if (estimate.covariance.size() == 0) return result;
  const filters::Gaussian found{estimate.state, directions * estimate.covariance * directions.transpose()};
  result.parameters = estimates(model, found);
  if (is_oscillator(model)) result.identification = identification_at(model, found);
  return result;
}

}  // namespace beamid::experiments
