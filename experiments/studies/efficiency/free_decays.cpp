#include "experiments/studies/efficiency/free_decays.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "experiments/models/one_coordinate.hpp"
#include "experiments/signal/positive.hpp"
#include "experiments/signal/random.hpp"
#include "filters/fisher_information.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr std::uint64_t noise_stream = 0, guess_stream = 1;

void check_free_decays(const DecaySettings& settings) {
  if (!(settings.damping_ratio > 0.0 && settings.damping_ratio < 1.0))
    throw std::invalid_argument("damping ratio: " + std::to_string(settings.damping_ratio) +
                                "; expected a number between 0 and 1");
  require_positive(settings.mass, "mass");
  require_positive(settings.frequency_hz, "frequency");
  require_positive(settings.amplitude, "amplitude");
  require_positive(settings.noise, "noise");
  require_positive(settings.samples_per_cycle, "samples per cycle");
  require_positive(settings.cycles, "cycles");
  require_positive(settings.time_constants, "time constants");
}

double cycles_seen(const DecaySettings& settings) {
  return std::min(settings.cycles,
                  settings.time_constants / (2.0 * std::numbers::pi * settings.damping_ratio));
}

}  // namespace

FreeDecays::FreeDecays(const DecaySettings& settings) : settings_(settings) {
  check_free_decays(settings);
  truth_ = Oscillator::from_frequency(settings.mass, 2.0 * std::numbers::pi * settings.frequency_hz,
                                      settings.damping_ratio);
  interval_ = 1.0 / (settings.frequency_hz * settings.samples_per_cycle);
  const double samples = std::round(cycles_seen(settings) * settings.samples_per_cycle);
  if (!(samples >= 16.0 && samples <= 1e7))
    throw std::invalid_argument("the record would have " + std::to_string(samples) +
                                " samples; expected 16 to 10000000");
  samples_ = static_cast<Index>(samples);
  motion_ = model_registry()
                .make("sdof", {}, at_one_point(one_coordinate(truth_), {Quantity::displacement}))
                ->motion;
  const std::complex<double> lambda = truth_.eigenvalue(), a = std::polar(settings.amplitude, settings.phase);
  decay_ = VectorXd::NullaryExpr(samples_, [&](Index k) {
    return (a * std::exp(lambda * (interval_ * static_cast<double>(k)))).real();
  });
  const Eigen::Vector4d start(a.real(), (a * lambda).real(), truth_.stiffness, truth_.damping);
  bound_ = filters::cramer_rao_bound(filters::fisher_information(*model(), start, samples_)).tail<2>();
}

std::unique_ptr<filters::DiscreteModel> FreeDecays::model() const {
  const double deviation = settings_.noise * settings_.amplitude;
  return filters::discretise(motion_, interval_, "exponential",
                             {{}, MatrixXd::Constant(1, 1, deviation * deviation)});
}

Eigen::Vector2d FreeDecays::guess_factors(std::uint64_t seed) const {
  if (settings_.guess == Guess::ends) return {seed & 1 ? 0.5 : 2.0, seed & 2 ? 0.5 : 2.0};
  // a normal number's own probability is uniform
  const VectorXd normal = standard_normal(2, seed, guess_stream);
  const auto factor = [](double z) { return std::exp2(std::erf(z / std::numbers::sqrt2)); };
  return {factor(normal[0]), factor(normal[1])};
}

filters::Trial FreeDecays::trial(std::uint64_t seed) const {
  filters::Trial trial;
  trial.truth = Eigen::Vector2d(truth_.stiffness, truth_.damping);
  trial.record.time = VectorXd::LinSpaced(samples_, 0.0, static_cast<double>(samples_ - 1)) * interval_;
  trial.record.outputs =
      (decay_ + settings_.noise * settings_.amplitude * standard_normal(samples_, seed, noise_stream))
          .transpose();
  const double largest = trial.record.outputs.cwiseAbs().maxCoeff();
  const Eigen::Vector2d guess = guess_factors(seed).cwiseProduct(trial.truth);
  trial.initial.mean = Eigen::Vector4d(0.0, 0.0, guess[0], guess[1]);
  const Eigen::Vector4d deviations(2.0 * largest, 2.0 * largest * std::sqrt(guess[0] / truth_.mass),
                                   0.75 * guess[0], guess[1]);
  trial.initial.covariance = deviations.cwiseAbs2().asDiagonal();
  return trial;
}

}  // namespace beamid::experiments
