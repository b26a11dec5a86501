#include "experiments/signal/onsets.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "experiments/signal/toolbox.hpp"

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

}  // namespace

Index SlidingMaximum::over(Index from, Index to) {
  for (; next_ < to; ++next_) {
    while (!places_.empty() && values_[places_.back()] < values_[next_]) places_.pop_back();
    places_.push_back(next_);
  }
  while (places_.front() < from) places_.pop_front();
  return places_.front();
}

Excursions excursions_of(const Eigen::VectorXd& signal) {
  constexpr double quiet = 0.05;
  if (signal.size() == 0) return {};
  const Eigen::ArrayXd from_median = signal.array() - median(signal);
  const double above = from_median.maxCoeff(), below = -from_median.minCoeff(), peak = std::max(above, below);
  if (peak <= 0.0) return {};
  return {
      static_cast<double>((from_median.abs() > quiet * peak).count()) / static_cast<double>(signal.size()),
      std::min(above, below) / peak};
}

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
  SlidingMaximum before(size);
  for (Index k = quiet.count; k < size.size(); ++k) {
    const bool separate = found.samples.empty() || k - found.samples.back() >= apart;
    if (separate && size[k] > level &&
        size[k] > settings.rise * size[before.over(std::max<Index>(0, k - apart), k)])
      found.samples.push_back(k);
  }
  return found;
}

std::string instant_text(double seconds) {
  constexpr int fewest = 4;
  const int whole = static_cast<int>(std::ceil(std::log10(std::max(1.0, std::abs(seconds)))));
  return fmt::format("{:.{}g}", seconds, std::max(fewest, whole + 1));
}

}  // namespace beamid::experiments
