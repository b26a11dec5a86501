#include "experiments/identify/first_belief.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double first_stiffness_doubt = 0.3;  // standard deviation of K0, relative: clamps are never ideal
constexpr double first_damping_ratio = 0.01;   // of C0, with a standard deviation as large

// Largest displacement [m] at frequency w [rad/s] behind a channel's largest reading. A clipped one was
// larger.
double displacement_scale(const Record& record, const RecordIdentification& found, double w) {
  double largest = largest_measured(record.samples.row(0));
  if (!record.samples.row(0).allFinite() && found.modal_failure.empty())
    largest = std::max(largest, found.modal.amplitude);
  switch (record.channels[0].quantity) {
    case Quantity::displacement:
      return largest;
    case Quantity::velocity:
      return largest / w;
    default:
      return largest / (w * w);
  }
}

}  // namespace

filters::Gaussian first_belief(const Experiment& experiment, const Record& record,
                               const RecordIdentification& found, double beam_stiffness) {
  const PriorBelief& prior = experiment.prior;
  const JointModel& model = found.model;
  const double mass = model.equivalent_mass, stiffness = prior.stiffness.value_or(beam_stiffness);
  const double w = std::sqrt(stiffness / mass), amplitude = displacement_scale(record, found, w);
  const double ratio = prior.damping_ratio.value_or(first_damping_ratio),
               to_damping = 2.0 * std::sqrt(stiffness * mass);
  const std::map<std::string, std::pair<double, double>> beliefs{
      {"displacement", {0.0, amplitude}},
      {"velocity", {0.0, amplitude * w}},
      {"stiffness", {stiffness, prior.stiffness_deviation.value_or(first_stiffness_doubt * stiffness)}},
      {"damping", {ratio * to_damping, prior.damping_ratio_deviation.value_or(ratio) * to_damping}},
      {"sensor_bias", {0.0, 0.1 * amplitude * w * w}}};
  const auto labels = model.motion->state_labels();
  const auto n = static_cast<Index>(labels.size());
  filters::Gaussian belief{VectorXd(n), Eigen::MatrixXd::Zero(n, n)};
  for (Index i = 0; i < n; ++i) {
    const auto& [mean, deviation] = beliefs.at(labels[static_cast<std::size_t>(i)].name);
    belief.mean[i] = mean;
    belief.covariance(i, i) = deviation * deviation;
  }
  return belief;
}

void start_from_mode(const PriorBelief& prior, double interval, RecordIdentification& found) {
  constexpr double counted_twice = 30, least = 0.01, largest_ratio = 0.5;
  const ModalEstimate& modal = found.modal;
  if (!(modal.damping_ratio < largest_ratio)) return;
  const double ratio = modal.damping_ratio > 0 ? modal.damping_ratio : first_damping_ratio;
  Oscillator start = Oscillator::from_frequency(found.model.equivalent_mass,
                                                2.0 * std::numbers::pi * modal.frequency_hz, ratio);
  try {
    start = seen_through(found.settings.discretisation, start, interval);
  } catch (const std::runtime_error&) {  // the step is too long for the scheme, which will show
  }
  if (!(start.stiffness > 0.0) || !std::isfinite(start.damping)) return;
  filters::Gaussian& belief = found.settings.initial;
  const auto take = [&](Index place, double mean, double deviation) {
    belief.mean[place] = mean;
    belief.covariance(place, place) = deviation * deviation;
  };
  const double frequency_doubt = modal.frequency_standard_deviation_hz / modal.frequency_hz,
               ratio_doubt = modal.damping_ratio_standard_deviation;
  if (!std::isfinite(frequency_doubt) || !std::isfinite(ratio_doubt)) return;
  if (!prior.stiffness && !prior.stiffness_deviation)
    take(2, start.stiffness,
         start.stiffness * std::clamp(counted_twice * 2.0 * frequency_doubt, least, first_stiffness_doubt));
  if (!prior.damping_ratio && !prior.damping_ratio_deviation)
    take(3, start.damping,
         std::max(std::abs(start.damping),
                  counted_twice * ratio_doubt * 2.0 * std::sqrt(start.stiffness * start.mass)));
}

}  // namespace beamid::experiments
