#include "experiments/signal/integration.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "experiments/signal/butterworth.hpp"

namespace beamid::experiments {
namespace {

Eigen::VectorXd without_mean(const Eigen::VectorXd& signal) {
  return signal.array() - signal.mean();
}

}  // namespace

Eigen::VectorXd cumulative_trapezoid(const Eigen::VectorXd& signal, double interval, double first) {
  Eigen::VectorXd integral(signal.size());
  double sum = first;
  for (Eigen::Index k = 0; k < signal.size(); ++k) {
    if (k > 0) sum += 0.5 * interval * (signal[k - 1] + signal[k]);
    integral[k] = sum;
  }
  return integral;
}

std::complex<double> trapezoidal_response(std::complex<double> rate, double interval) {
  return 0.5 * interval / std::tanh(0.5 * interval * rate);  // (z + 1)/(z - 1) = coth(s dt / 2)
}

CascadedFilter processing_filter(const ProcessingSettings& settings, double interval) {
  CascadedFilter high_pass = butterworth_high_pass(settings.high_pass_order, settings.high_pass_hz, interval);
  if (!settings.low_pass_hz) return high_pass;
  return cascade(high_pass, butterworth_low_pass(settings.low_pass_order, *settings.low_pass_hz, interval));
}

ProcessedMotion process_acceleration(const Eigen::VectorXd& acceleration, double interval,
                                     const ProcessingSettings& settings) {
  const CascadedFilter filter = processing_filter(settings, interval);
  const Eigen::Index count = acceleration.size();
  if (count < 2)
    throw std::invalid_argument("acceleration of " + std::to_string(count) +
                                " samples; expected at least 2 to integrate");
  ProcessedMotion motion;
  motion.settled_begin = settling_samples(filter, settings.transient_tolerance);
  if (settings.zero_phase) {
    const Eigen::VectorXd velocity = without_mean(cumulative_trapezoid(without_mean(acceleration), interval));
    motion.acceleration = filter_forward_backward(filter, acceleration);
    motion.velocity = filter_forward_backward(filter, velocity);
    motion.displacement = filter_forward_backward(filter, cumulative_trapezoid(velocity, interval));
    motion.settled_end = count - motion.settled_begin;
  } else {
    const double half = 0.5 * interval;
    motion.acceleration = filter_causally(filter, acceleration);
    motion.velocity = cumulative_trapezoid(motion.acceleration, interval, half * motion.acceleration[0]);
    motion.displacement = cumulative_trapezoid(motion.velocity, interval, half * motion.velocity[0]);
    motion.settled_end = count;
  }
  return motion;
}

}  // namespace beamid::experiments
