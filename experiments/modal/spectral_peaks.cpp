#include "experiments/modal/spectral_peaks.hpp"

#include <algorithm>

#include "experiments/signal/amplitude_spectrum.hpp"
#include "experiments/signal/median.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// The largest of the two valleys that part line k from a larger value on either side; an end of the
/// spectrum is no larger value.
double valley_beside(const VectorXd& spectrum, Index k) {
  double deepest_needed = 0;
  for (const Index direction : {-1, 1}) {
    double valley = spectrum[k];
    for (Index j = k + direction; j >= 0 && j < spectrum.size(); j += direction) {
      valley = std::min(valley, spectrum[j]);
      if (spectrum[j] <= spectrum[k]) continue;
      deepest_needed = std::max(deepest_needed, valley);
      break;
    }
  }
  return deepest_needed;
}

}  // namespace

std::vector<SpectralLine> spectral_lines(const Eigen::MatrixXd& outputs, double interval,
                                         const LineSettings& settings) {
  AmplitudeSpectrum first = amplitude_spectrum(outputs.row(0).transpose(), interval);
  VectorXd spectrum = first.amplitude.cwiseAbs2();
  for (Index i = 1; i < outputs.rows(); ++i)
    spectrum += amplitude_spectrum(outputs.row(i).transpose(), interval).amplitude.cwiseAbs2();
  spectrum = spectrum.cwiseSqrt();
  const double line = 1 / (interval * static_cast<double>(outputs.cols()));
  const double step = first.frequency_hz[1];
  const auto lobe = static_cast<Index>(2 * line / step);
  const Index around = std::max<Index>(16 * lobe, spectrum.size() / 8);
  const double least = settings.least * spectrum.maxCoeff();
  std::vector<SpectralLine> lines;
  for (Index k = lobe; k + 1 < spectrum.size(); ++k) {
    const Index from = std::max<Index>(0, k - lobe), to = std::min(spectrum.size() - 1, k + lobe);
    if (spectrum[k] < least || spectrum[k] < spectrum.segment(from, to - from + 1).maxCoeff()) continue;
    const Index left = std::max<Index>(0, k - around), right = std::min(spectrum.size() - 1, k + around);
    if (spectrum[k] < settings.above_noise * median(VectorXd(spectrum.segment(left, right - left + 1))))
      continue;
    if (spectrum[k] < settings.above_valley * valley_beside(spectrum, k)) continue;
    lines.push_back({first.frequency_hz[k], spectrum[k]});
  }
  return lines;
}

std::vector<double> spectral_peaks(const Eigen::MatrixXd& outputs, double interval) {
  std::vector<double> peaks;
  for (const SpectralLine& line : spectral_lines(outputs, interval)) peaks.push_back(line.frequency_hz);
  return peaks;
}

}  // namespace beamid::experiments
