#include "experiments/signal/frequency_calculus.hpp"

#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace beamid::experiments {
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
