
#include "experiments/studies/steps/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/truth_behind.hpp"

namespace beamid::experiments {
namespace {

FoundMode mode_of_oscillator(const Oscillator& one) {
  return {one.frequency_hz(), one.damping_ratio()};
}

// The truth behind a ratio that is seen at this frequency, or in a structure of it.
Oscillator truth_of_ratio(const PublishedDamping& published, double ratio) {
  const double omega = 2.0 * std::numbers::pi * published.frequency_hz, dt = published.interval;
  if (!published.is_true_frequency)
    return truth_behind(published.scheme, Oscillator::from_frequency(1.0, omega, ratio), dt);
  return truth_with_ratio(ratio, omega,
                          [&](const Oscillator& truth) { return seen_through(published.scheme, truth, dt); });
}

std::optional<double> ratio_with_process_noise(const PublishedDamping& published, double omega) {
  if (published.scheme != "forward_euler") return {};
  try {
    const auto seen = [&](const Oscillator& truth) {
      return regressed_by_forward_euler(truth, published.interval);
    };
    return truth_with_ratio(published.ratio, omega, seen).damping_ratio();
  } catch (const std::runtime_error&) {
    return {};
  }
}

}  // namespace

double half_digit_of(const std::string& number) {
  const std::size_t power = number.find_first_of("eE"), point = number.find('.');
  const std::string mantissa = number.substr(0, power);
  const double decimals = point < mantissa.size() ? static_cast<double>(mantissa.size() - point - 1) : 0.0;
  const double exponent = power == std::string::npos ? 0.0 : std::strtod(number.c_str() + power + 1, nullptr);
  return 0.5 * std::pow(10.0, exponent - decimals);
}

BehindPublished behind_published(const PublishedDamping& published) {
  BehindPublished found{published, {}, 0.0, 0.0, 0.0, {}};
  try {
    const Oscillator truth = truth_of_ratio(published, published.ratio);
    found.truth = mode_of_oscillator(truth);
    const double half = published.half_digit;
    found.lower = truth_of_ratio(published, std::max(published.ratio - half, -0.99)).damping_ratio();
    found.upper = truth_of_ratio(published, std::min(published.ratio + half, 0.99)).damping_ratio();
    found.least =
        seen_through(published.scheme, Oscillator::from_frequency(1.0, truth.angular_frequency(), 0.0),
                     published.interval)
            .damping_ratio();
    found.with_process_noise = ratio_with_process_noise(published, truth.angular_frequency());
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(error.what());
  }
  return found;
}

}  // namespace beamid::experiments
