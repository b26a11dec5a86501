#include "experiments/modal/study/record_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/modal/spectral_peaks.hpp"

namespace beamid::experiments {

using Eigen::Index;

std::vector<RecordLine> record_lines(const Eigen::MatrixXd& samples, double interval) {
  constexpr Index fewest = 128;
  constexpr LineSettings line{.above_noise = 6, .above_valley = 2, .least = 0.02};
  std::vector<RecordLine> found;
  for (Index count = samples.cols(); count >= std::min(fewest, samples.cols()); count /= 4) {
    const double resolution = 2 / (interval * static_cast<double>(count));
    const std::vector<SpectralLine> lines = spectral_lines(samples.leftCols(count), interval, line);
    double strongest = 0;
    for (const SpectralLine& one : lines) strongest = std::max(strongest, one.amplitude);
    for (const SpectralLine& one : lines) {
      const auto known = std::find_if(found.begin(), found.end(), [&](const RecordLine& other) {
        return std::abs(other.frequency_hz - one.frequency_hz) < resolution;
      });
      const double share = one.amplitude / strongest;
      if (known == found.end())
        found.push_back({one.frequency_hz, resolution, share});
      else
        known->share = std::max(known->share, share);
    }
    if (count < 4) break;
  }
  std::sort(found.begin(), found.end(),
            [](const RecordLine& a, const RecordLine& b) { return a.frequency_hz < b.frequency_hz; });
  return found;
}

std::string frequencies_text(const std::vector<double>& frequencies_hz) {
  constexpr std::size_t most = 6;
  const std::size_t shown = std::min(most, frequencies_hz.size());
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) {
    const bool last = i + 1 == frequencies_hz.size();
    text += fmt::format("{}{:.4g}", i == 0 ? "" : last ? " and " : ", ", frequencies_hz[i]);
  }
  text += " Hz";
  if (shown < frequencies_hz.size()) text += fmt::format(" and {} more", frequencies_hz.size() - shown);
  return text;
}

}  // namespace beamid::experiments
