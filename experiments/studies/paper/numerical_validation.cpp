#include "experiments/studies/paper/numerical_validation.hpp"

#include <cmath>
#include <numbers>

#include "experiments/models/one_coordinate.hpp"
#include "experiments/signal/random.hpp"
#include "experiments/studies/paper/data_generator.hpp"

namespace beamid::experiments::paper {
namespace {

// The first sample is one interval after the release.
filters::Measurements simulate_oscillator(const ValidationSettings& settings) {
  const auto samples = static_cast<Eigen::Index>(std::lround(settings.duration / settings.interval));
  filters::Measurements record;
  record.time = Eigen::VectorXd::LinSpaced(samples, 1.0, static_cast<double>(samples)) * settings.interval;
  const Eigen::MatrixXd motion =
      generate_decay(settings.data, settings.truth, settings.release, settings.interval, samples);
  record.outputs.resize(static_cast<Eigen::Index>(settings.observed.size()), samples);
  for (Eigen::Index i = 0; i < record.outputs.rows(); ++i) {
    const Eigen::Index row = settings.observed[i] == Quantity::displacement ? 0 : 1;
    record.outputs.row(i) = motion.row(row);
    if (settings.sensor_noise[row] > 0.0)
      record.outputs.row(i) +=
          settings.sensor_noise[row] *
          standard_normal(samples, settings.seed, static_cast<std::uint64_t>(row)).transpose();
  }
  return record;
}

// R, by what is observed
Eigen::MatrixXd output_noise_of(const ValidationSettings& settings) {
  Eigen::VectorXd variance(static_cast<Eigen::Index>(settings.observed.size()));
  for (Eigen::Index i = 0; i < variance.size(); ++i)
    variance[i] = settings.observed[i] == Quantity::velocity && settings.velocity_variance > 0.0
                      ? settings.velocity_variance
                      : settings.noise_variance;
  return variance.asDiagonal();
}

}  // namespace

Oscillator validation_truth() {
  return Oscillator::from_frequency(3.0, std::sqrt(515.8 / 3.0), 0.10);
}

const std::vector<std::string>& compared_schemes() {
  static const std::vector<std::string> schemes{"forward_euler", "backward_euler", "implicit_midpoint",
                                                "runge_kutta_2", "runge_kutta_4",  "exponential"};
  return schemes;
}

ValidationSettings bias_settings() {
  ValidationSettings settings;
  settings.observed = {Quantity::displacement};
  settings.noise_variance = 1e-12;
  settings.passes = 2;
  return settings;
}

Identification validate(const std::string& filter, const std::string& scheme,
                        const ValidationSettings& settings, filters::Keep keep) {
  const auto model =
      model_registry().make("sdof", {}, at_one_point(one_coordinate(settings.truth), settings.observed));
  IdentificationSettings identification;
  identification.filter = filter;
  identification.discretisation = scheme;
  identification.initial.mean =
      Eigen::Vector4d(settings.release, 0.0, settings.first_stiffness, settings.first_damping);
  identification.initial.covariance = settings.initial_variance.asDiagonal();
  identification.output_noise = output_noise_of(settings);
  if (settings.process_variance > 0.0)
    identification.process_noise =
        Eigen::Vector4d(settings.process_variance, settings.process_variance, 0.0, 0.0).asDiagonal();
  identification.start = filters::Start::one_interval_before;
  identification.passes = settings.passes;
  return identify(*model, simulate_oscillator(settings), identification, keep);
}

}  // namespace beamid::experiments::paper
