#include "experiments/signal/spectrum.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <string>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace beamid::experiments {
namespace {

/// Magnitudes at k / (length dt), k = 0 .. length/2.
std::vector<double> magnitudes(const Eigen::VectorXd& signal, std::size_t length) {
  const double mean = signal.mean(), turn = 2 * std::numbers::pi / static_cast<double>(signal.size());
  std::vector<double> padded(length, 0.0);
  for (Eigen::Index k = 0; k < signal.size(); ++k)
    padded[k] = (signal[k] - mean) * (1 - std::cos(turn * (static_cast<double>(k) + 0.5)));
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> spectrum;
  transform.fwd(spectrum, padded);
  std::vector<double> result(spectrum.size());
  std::transform(spectrum.begin(), spectrum.end(), result.begin(),
                 [](auto value) { return std::abs(value); });
  return result;
}

}  // namespace

double strongest_frequency(const Eigen::VectorXd& signal, double interval) {
  const auto count = static_cast<std::size_t>(signal.size());
  if (count < 16)
    throw std::invalid_argument("signal of " + std::to_string(count) +
                                " samples; expected at least 16 to find its frequency");
  const std::size_t length = std::bit_ceil(2 * count);
  const std::vector<double> magnitude = magnitudes(signal, length);
  const auto first = magnitude.begin() + static_cast<std::ptrdiff_t>(2 * length / count + 1);
  const auto peak = std::max_element(first, magnitude.end() - 1);
  if (!(*peak > 0)) throw std::invalid_argument("a signal without any variation has no frequency");
  const double left = std::log(*(peak - 1)), centre = std::log(*peak), right = std::log(*(peak + 1));
  const double curvature = left - 2 * centre + right;
  const double shift = curvature < 0 ? 0.5 * (left - right) / curvature : 0;
  return (static_cast<double>(peak - magnitude.begin()) + (std::isfinite(shift) ? shift : 0)) /
         (static_cast<double>(length) * interval);
}

}  // namespace beamid::experiments
