#include "experiments/identification.hpp"

#include <cmath>
#include <numbers>

namespace beamid::experiments {
namespace {

// Standard deviation of a . [K, C] for the covariance of K and C.
double deviation(const Eigen::Matrix2d& covariance, double by_stiffness, double by_damping) {
  const Eigen::Vector2d slope(by_stiffness, by_damping);
  return std::sqrt(slope.dot(covariance * slope));
}

}  // namespace

Identification identify(const JointModel& model, const filters::Measurements& record,
                        const IdentificationSettings& settings, filters::Keep keep) {
  const double dt =
      (record.time[record.time.size() - 1] - record.time[0]) / static_cast<double>(record.time.size() - 1);
  const auto filter = filters::filter_registry().make(
      settings.filter, settings.filter_options,
      filters::discretise(model.motion, dt, settings.discretisation, {{}, settings.output_noise}));
  filters::Gaussian initial = settings.initial;
  Identification result;
  for (int pass = 1; pass <= settings.passes; ++pass) {
    const bool last = pass == settings.passes;
    result.run =
        filters::run(*filter, initial, record, last ? keep : filters::Keep::last_belief, settings.start);
    if (result.run.failure) break;
    const Eigen::Index constants = initial.mean.size() - 2 * model.motion_size();
    initial.mean.tail(constants) = result.run.last.mean.tail(constants);
  }
  const Eigen::VectorXd& mean = result.run.last.mean;
  const Eigen::Matrix2d covariance = result.run.last.covariance.block<2, 2>(2, 2);
  result.found = {model.equivalent_mass, mean[2], mean[3]};
  result.stiffness_deviation = deviation(covariance, 1.0, 0.0);
  result.damping_deviation = deviation(covariance, 0.0, 1.0);
  // f = sqrt(K/M) / 2 pi and xi = C / (2 sqrt(K M)), to first order in the errors of K and C
  const auto& [mass, stiffness, damping] = result.found;
  result.frequency_deviation_hz =
      deviation(covariance, 0.25 / (std::numbers::pi * std::sqrt(stiffness * mass)), 0.0);
  result.damping_ratio_deviation = deviation(covariance, -0.5 * result.found.damping_ratio() / stiffness,
                                             0.5 / std::sqrt(stiffness * mass));
  return result;
}

bool lost(const Identification& result, double modal_frequency_hz) {
  const Oscillator& found = result.found;
  const double omega = 2.0 * std::numbers::pi * modal_frequency_hz;
  const bool near = std::abs(found.stiffness / found.mass / (omega * omega) - 1.0) < 0.05;
  return result.run.failure || !near || !(found.stiffness > 0.0) || !(found.damping > 0.0);
}

}  // namespace beamid::experiments
