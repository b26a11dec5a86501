#include "experiments/modal/study/signal_band.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "experiments/signal/amplitude_spectrum.hpp"

namespace beamid::experiments {

namespace {

constexpr double margin = 1.3, highest = 0.45;

}  // namespace

std::pair<double, double> signal_band(const Eigen::MatrixXd& samples, double interval) {
  constexpr double least = 0.05;
  const double lowest = 2 / (interval * static_cast<double>(samples.cols()));
  double top = 2 * lowest;
  for (Eigen::Index i = 0; i < samples.rows(); ++i) {
    const AmplitudeSpectrum spectrum = amplitude_spectrum(samples.row(i).transpose(), interval);
    double peak = 0;
    for (Eigen::Index k = 0; k < spectrum.amplitude.size(); ++k)
      if (spectrum.frequency_hz[k] >= lowest) peak = std::max(peak, spectrum.amplitude[k]);
    for (Eigen::Index k = spectrum.amplitude.size() - 1; k >= 0; --k)
      if (spectrum.amplitude[k] >= least * peak) {
        top = std::max(top, margin * spectrum.frequency_hz[k]);
        break;
      }
  }
  return {lowest, std::min(top, highest / interval)};
}

std::pair<double, double> decay_band(const Eigen::MatrixXd& samples, double interval,
                                     const std::vector<RecordLine>& lines) {
  std::pair<double, double> band = signal_band(samples, interval);
  for (const RecordLine& line : lines) band.second = std::max(band.second, margin * line.frequency_hz);
  band.second = std::min(band.second, highest / interval);
  return band;
}

void check_band(std::pair<double, double> band_hz, double interval, Eigen::Index count) {
  const auto [from, to] = band_hz;
  if (from >= 0 && from < to && to < 0.5 / interval && to * interval * static_cast<double>(count) > 2) return;
  throw std::invalid_argument(fmt::format(
      "band {:g} to {:g} Hz; expected 0 <= from < to, and to between {:.4g} Hz, two cycles in the "
      "record, and {:.6g} Hz, half its sampling rate",
      from, to, 2 / (interval * static_cast<double>(count)), 0.5 / interval));
}

}  // namespace beamid::experiments
