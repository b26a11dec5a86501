#include "experiments/studies/paper/numerical_validation.hpp"

#include <cmath>
#include <numbers>

#include "experiments/models/one_coordinate.hpp"
#include "fem/free_decay.hpp"

namespace beamid::experiments::paper {
namespace {

filters::Measurements simulate_oscillator(const ValidationSettings& settings) {
  const Oscillator& truth = settings.truth;
  const auto samples = static_cast<Eigen::Index>(std::lround(settings.duration / settings.interval));
  const auto one = [](double value) { return Eigen::VectorXd::Constant(1, value); };
  filters::Measurements record;
  record.time = Eigen::VectorXd::LinSpaced(samples, 1.0, static_cast<double>(samples)) * settings.interval;
  const fem::Motion motion = fem::free_decay(one(settings.release), one(truth.angular_frequency()),
                                             one(truth.damping_ratio()), record.time);
  record.outputs.resize(static_cast<Eigen::Index>(settings.observed.size()), samples);
  for (Eigen::Index i = 0; i < record.outputs.rows(); ++i)
    record.outputs.row(i) =
        settings.observed[i] == Quantity::displacement ? motion.displacement : motion.velocity;
  return record;
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
  const auto outputs = static_cast<Eigen::Index>(settings.observed.size());
  IdentificationSettings identification;
  identification.filter = filter;
  identification.discretisation = scheme;
  identification.initial.mean =
      Eigen::Vector4d(settings.release, 0.0, settings.first_stiffness, settings.first_damping);
  identification.initial.covariance = settings.initial_variance.asDiagonal();
  identification.output_noise = settings.noise_variance * Eigen::MatrixXd::Identity(outputs, outputs);
  identification.start = filters::Start::one_interval_before;
  identification.passes = settings.passes;
  return identify(*model, simulate_oscillator(settings), identification, keep);
}

}  // namespace beamid::experiments::paper
