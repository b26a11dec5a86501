#include "experiments/identify/batch.hpp"

#include <numbers>

namespace beamid::experiments {

BatchIdentification identify_batch(const RecordIdentification& found, const filters::Measurements& measured) {
  const IdentificationSettings& settings = found.settings;
  const Oscillator modal = Oscillator::from_frequency(found.model.equivalent_mass,
                                                      2.0 * std::numbers::pi * found.modal.frequency_hz,
                                                      found.modal.damping_ratio);
  Eigen::VectorXd start = settings.initial.mean;
  start[2] = modal.stiffness, start[3] = modal.damping;
  const Eigen::MatrixXd directions = settings.initial.deviations().asDiagonal();
  const auto model = filters::discretise(found.model.motion, measured.interval(), settings.discretisation,
                                         {{}, settings.output_noise});
  BatchIdentification result;
  result.estimate = filters::estimate_batch(*model, start, directions, measured);
  const filters::BatchEstimate& estimate = result.estimate;
  if (estimate.covariance.size() == 0) return result;
  const Eigen::MatrixXd spread = directions * estimate.covariance * directions.transpose();
  result.identification = identification_at(found.model, {estimate.state, spread});
  return result;
}

}  // namespace beamid::experiments
