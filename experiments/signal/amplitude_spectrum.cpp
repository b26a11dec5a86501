#include "experiments/signal/amplitude_spectrum.hpp"

#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace beamid::experiments {

AmplitudeSpectrum amplitude_spectrum(const Eigen::VectorXd& signal, double interval) {
  const auto count = static_cast<std::size_t>(signal.size()), length = std::bit_ceil(2 * count);
  const double mean = signal.mean(), turn = 2.0 * std::numbers::pi / static_cast<double>(count);
  std::vector<double> padded(length, 0.0);
  for (std::size_t k = 0; k < count; ++k)
    padded[k] = (signal[static_cast<Eigen::Index>(k)] - mean) *
                (1.0 - std::cos(turn * (static_cast<double>(k) + 0.5)));
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> spectrum;
  transform.fwd(spectrum, padded);
  const auto size = static_cast<Eigen::Index>(spectrum.size());
  AmplitudeSpectrum result{Eigen::VectorXd(size), Eigen::VectorXd(size)};
  for (Eigen::Index k = 0; k < size; ++k) {
    result.frequency_hz[k] = static_cast<double>(k) / (static_cast<double>(length) * interval);
    result.amplitude[k] = 2.0 / static_cast<double>(count) * std::abs(spectrum[k]);  // the window's mean is 1
  }
  return result;
}

}  // namespace beamid::experiments
