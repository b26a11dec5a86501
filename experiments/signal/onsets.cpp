#include "experiments/signal/onsets.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <stdexcept>
#include <string>

namespace beamid::experiments {
namespace {

using Eigen::Index;
constexpr Index fewest = 8;

/// Running mean and variance of the samples taken so far.
struct Spread {
  Index count = 0;
  double mean = 0, squares = 0;

  void add(double sample) {
    const double from_old = sample - mean;
    mean += from_old / static_cast<double>(++count);
    squares += from_old * (sample - mean);
  }
  double deviation() const { return count > 1 ? std::sqrt(squares / static_cast<double>(count - 1)) : 0; }
};

Spread quiet_part(const Eigen::VectorXd& signal, double interval, const OnsetSettings& settings) {
  Spread spread;
  if (settings.quiet_duration > 0) {
    const Index count = std::min<Index>(
        signal.size(), std::max(fewest, static_cast<Index>(settings.quiet_duration / interval) + 1));
    for (Index k = 0; k < count; ++k) spread.add(signal[k]);
    return spread;
  }
  for (Index k = 0; k < fewest; ++k) spread.add(signal[k]);
  const double smallest = settings.smallest * (signal.array() - spread.mean).abs().maxCoeff();
  for (Index k = fewest; k < signal.size(); ++k) {
    if (std::abs(signal[k] - spread.mean) > std::max(settings.threshold * spread.deviation(), smallest))
      break;
    spread.add(signal[k]);
  }
  return spread;
}

/// The largest of the last `length` values.
class SlidingMaximum {
 public:
  explicit SlidingMaximum(Index length) : length_(length) {}

  double value() const { return kept_.empty() ? 0 : kept_.front().second; }
  void add(Index k, double value) {
    while (!kept_.empty() && kept_.back().second <= value) kept_.pop_back();
    kept_.emplace_back(k, value);
    if (kept_.front().first <= k - length_) kept_.pop_front();
  }

 private:
  Index length_;
  std::deque<std::pair<Index, double>> kept_;
};

}  // namespace

Onsets find_onsets(const Eigen::VectorXd& signal, double interval, const OnsetSettings& settings) {
  if (signal.size() < 2 * fewest)
    throw std::invalid_argument("signal of " + std::to_string(signal.size()) +
                                " samples; expected at least 16 to find events");
  if (!(settings.threshold > 0 && settings.smallest > 0 && settings.rise > 0 && settings.apart > 0))
    throw std::invalid_argument("threshold, smallest, rise and apart of events; expected positive numbers");
  const Spread quiet = quiet_part(signal, interval, settings);
  Onsets found{quiet.mean, quiet.deviation(), quiet.count, {}};
  const Eigen::VectorXd size = (signal.array() - quiet.mean).abs();
  const double level = std::max(settings.threshold * found.noise, settings.smallest * size.maxCoeff());
  const auto apart = std::max<Index>(1, static_cast<Index>(std::ceil(settings.apart / interval)));
  SlidingMaximum before(apart);
  for (Index k = 0; k < size.size(); ++k) {
    const bool separate = found.samples.empty() || k - found.samples.back() >= apart;
    if (k >= quiet.count && separate && size[k] > level && size[k] > settings.rise * before.value())
      found.samples.push_back(k);
    before.add(k, size[k]);
  }
  return found;
}

}  // namespace beamid::experiments
