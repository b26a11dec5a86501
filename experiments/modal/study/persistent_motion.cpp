#include "experiments/modal/study/persistent_motion.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "experiments/signal/median.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd;

constexpr int resolutions_beside = 3;  // resolutions

/// Power of all channels at a frequency under a Hann window.
double windowed_power(const MatrixXd& samples, double interval, double frequency_hz) {
  const Index count = samples.cols();
  Eigen::VectorXcd wave(count);
  for (Index k = 0; k < count; ++k) {
    const double t = static_cast<double>(k), turn = 2.0 * std::numbers::pi;
    wave[k] = std::polar(0.5 - 0.5 * std::cos(turn * (t + 0.5) / static_cast<double>(count)),
                         -turn * frequency_hz * interval * t);
  }
  return (samples.cast<std::complex<double>>() * wave).squaredNorm();
}

/// Mean power about a frequency.
double power_about(const MatrixXd& samples, double interval, double frequency_hz) {
  const double step = 1.0 / (interval * static_cast<double>(samples.cols()));
  double sum = 0.0;
  for (int k = -resolutions_beside; k <= resolutions_beside; ++k)
    sum += windowed_power(samples, interval, frequency_hz + k * step);
  return sum / (2 * resolutions_beside + 1);
}

double median_power(const MatrixXd& samples, double interval, std::pair<double, double> band_hz) {
  constexpr int fewest = 20, most = 200;
  const double resolutions =
      (band_hz.second - band_hz.first) * interval * static_cast<double>(samples.cols());
  const int count = std::clamp(static_cast<int>(resolutions), fewest, most);
  std::vector<double> powers;
  for (int k = 0; k < count; ++k)
    powers.push_back(windowed_power(samples, interval,
                                    band_hz.first + (k + 0.5) / count * (band_hz.second - band_hz.first)));
  return median(powers);
}

double motion_size_of(const MatrixXd& samples) {
  return (samples.colwise() - samples.rowwise().mean()).norm();
}

/// Whether the motion of some periods is larger than that of some before.
bool motion_rises(const MatrixXd& motion, Index part) {
  constexpr double larger = 1.2;
  if (part < 4) return true;
  double least = motion_size_of(motion.leftCols(std::min(part, motion.cols())));
  for (Index at = part; at + part <= motion.cols(); at += part) {
    const double size = motion_size_of(motion.middleCols(at, part));
    if (size > larger * least) return true;
    least = std::min(least, size);
  }
  return false;
}

Index samples_in_periods(double periods, const ModeEstimate& mode, double interval) {
  return static_cast<Index>(periods / (mode.pole.frequency_hz() * interval));
}

}  // namespace

bool motion_goes_on(const RecordModes& found) {
  constexpr double least_left = 0.15, above_median = 10.0, as_early = 0.25;
  if (found.reproduced.size() == 0 || found.modes.empty()) return false;
  const MatrixXd left = found.target - found.reproduced;
  const MatrixXd motion = found.target.colwise() - found.target.rowwise().mean();
  if (left.norm() < least_left * motion.norm() ||
      !motion_rises(motion, samples_in_periods(4.0, found.strongest(), found.interval)))
    return false;
  const MatrixXd early = left.leftCols(left.cols() / 2), late = left.rightCols(left.cols() / 2);
  const double usual = median_power(late, found.interval, found.band_hz);
  return std::any_of(found.modes.begin(), found.modes.end(), [&](const ModeEstimate& mode) {
    const double f = mode.pole.frequency_hz(), power = power_about(late, found.interval, f);
    return power > above_median * usual && power > as_early * power_about(early, found.interval, f);
  });
}

bool moved_before(const Record& whole, const RecordModes& found) {
  constexpr double as_much = 0.7;
  if (found.modes.empty()) return false;
  const Index before = whole.size() - found.record.size();
  if (before <= found.record.size()) return false;
  const Index part =
      std::min(found.record.size(), samples_in_periods(2.0, found.strongest(), whole.interval()));
  if (part < 2 || part > before) return false;
  return motion_size_of(whole.samples.middleCols(before - part, part)) >
         as_much * motion_size_of(whole.samples.middleCols(before, part));
}

}  // namespace beamid::experiments
