#include "experiments/signal/integration.hpp"

#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <unsupported/Eigen/FFT>

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

namespace {

using Complex = std::complex<double>;

void check_frequency_calculus(Eigen::Index count, double interval, int times) {
  if (count < 2 || !(interval > 0) || times < 1 || times > 2)
    throw std::invalid_argument("signal of " + std::to_string(count) + " samples, " + std::to_string(times) +
                                " times; expected 2 samples or more, and 1 or 2 times");
}

/// The signal between its reflections (even: mirrored; odd: mirrored and negated), which a cosine brings down
/// to zero, with every bin of its spectrum multiplied by factor(f).
Eigen::VectorXd filtered(const Eigen::VectorXd& signal, double interval, bool even,
                         const std::function<Complex(double)>& factor) {
  const Eigen::Index count = signal.size(), pad = count - 1;
  const std::size_t length = std::bit_ceil(static_cast<std::size_t>(count + 2 * pad));
  std::vector<double> extended(length, 0.0);
  for (Eigen::Index k = 0; k < count; ++k) extended[pad + k] = signal[k];
  for (Eigen::Index k = 1; k <= pad; ++k) {
    const double fall =
        0.5 * (1 + std::cos(std::numbers::pi * static_cast<double>(k) / static_cast<double>(count)));
    const double weight = even ? fall : -fall;
    extended[pad - k] = weight * signal[k];
    extended[pad + count - 1 + k] = weight * signal[count - 1 - k];
  }
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<Complex> spectrum;
  transform.fwd(spectrum, extended);
  for (std::size_t k = 0; k < spectrum.size(); ++k)
    spectrum[k] *= factor(static_cast<double>(k) / (static_cast<double>(length) * interval));
  transform.inv(extended, spectrum, static_cast<Eigen::Index>(length));
  return Eigen::Map<const Eigen::VectorXd>(extended.data() + pad, count);
}

}  // namespace

double above_corner(double frequency_hz, double corner_hz) {
  const double x = frequency_hz / corner_hz;
  if (x <= 0.5) return 0;
  return x >= 1 ? 1 : 0.5 * (1 - std::cos(2 * std::numbers::pi * (x - 0.5)));
}

Eigen::VectorXd integrate_in_frequency(const Eigen::VectorXd& signal, double interval, int times,
                                       double corner_hz) {
  check_frequency_calculus(signal.size(), interval, times);
  if (!(corner_hz > 0 && corner_hz < 0.5 / interval))
    throw std::invalid_argument("corner of " + std::to_string(corner_hz) +
                                " Hz; expected a value between 0 and half the sampling rate, " +
                                std::to_string(0.5 / interval) + " Hz");
  return filtered(signal, interval, true, [&](double f) {
    const double weight = above_corner(f, corner_hz);
    return weight > 0 ? weight / std::pow(Complex(0, 2 * std::numbers::pi * f), times) : Complex(0);
  });
}

Eigen::VectorXd differentiate_in_frequency(const Eigen::VectorXd& signal, double interval, int times) {
  check_frequency_calculus(signal.size(), interval, times);
  const Eigen::Index last = signal.size() - 1;
  const Eigen::VectorXd line = Eigen::VectorXd::LinSpaced(signal.size(), signal[0], signal[last]);
  const double slope = (signal[last] - signal[0]) / (static_cast<double>(last) * interval);
  const Eigen::VectorXd rest = filtered(signal - line, interval, false, [&](double f) {
    return std::pow(Complex(0, 2 * std::numbers::pi * f), times);
  });
  return times == 1 ? Eigen::VectorXd(rest.array() + slope) : rest;
}

}  // namespace beamid::experiments
