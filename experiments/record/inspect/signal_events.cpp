// Releases, hits and a wandering offset in one channel.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "experiments/record/inspect/inspection.hpp"
#include "experiments/signal/onsets.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

std::vector<SignalEvent> find_events(const VectorXd& signal, double interval, double noise,
                                     double frequency_hz) {
  constexpr double rise = 2.5, above_noise = 10.0, smallest = 0.05, resting = 0.01, fewest_cycles = 5.0;
  const Index size = signal.size();
  std::vector<SignalEvent> events;
  if (size < 16) return events;
  const VectorXd deviation = signal.array() - median(signal);
  const VectorXd distance = deviation.cwiseAbs();
  const double largest = distance.maxCoeff();
  const double at_rest = median(distance);
  const bool pulse = at_rest < resting * largest && at_rest < 5 * noise;
  const double cycles = frequency_hz * interval * static_cast<double>(size);
  if (!pulse && cycles < fewest_cycles) return events;
  Index window = 8;
  if (!pulse && frequency_hz > 0)
    window = std::clamp<Index>(static_cast<Index>(2 / (frequency_hz * interval)) + 1, 8, size / 10 + 8);
  const double level = std::max(above_noise * noise, smallest * largest);
  if (!(largest > level)) return events;
  SlidingMaximum behind(distance), ahead(distance);
  Index free_from = 0;
  for (Index k = 1; k < size; ++k) {
    if (k < free_from || distance[k] <= level) continue;
    const double before = distance[behind.over(std::max<Index>(0, k - window), k)];
    const Index peak = ahead.over(k, std::min(k + window, size)) - k;
    if (distance[k + peak] <= rise * before) continue;
    Index start = k;  // back to where the rise begins
    while (start > 0 && k - start < window && distance[start - 1] < distance[start] &&
           distance[start] > 3 * noise)
      --start;
    events.push_back({start, deviation[k + peak], pulse});
    free_from = k + std::max<Index>(peak, 1) + window;
  }
  return events;
}

void take_slow_release(const VectorXd& signal, double interval, double frequency_hz,
                       std::vector<SignalEvent>& events) {
  constexpr double deflected = 1.0 / 3;
  constexpr Index fewest = 65, apart = 16;
  if (signal.size() < fewest) return;
  const VectorXd differences = signal.tail(signal.size() - 1) - signal.head(signal.size() - 1);
  const VectorXd deviation = signal.array() - median(signal);
  const double largest = deviation.cwiseAbs().maxCoeff();
  for (const SignalEvent& event :
       find_events(differences, interval, noise_floor(differences), frequency_hz)) {
    const Index at = event.sample;
    if (event.pulse || !(std::abs(deviation[at]) > deflected * largest)) continue;
    std::erase_if(events, [&](const SignalEvent& pull) {
      if (pull.sample >= at) return pull.sample - at < apart;
      const auto held = deviation.segment((pull.sample + at) / 2, at - (pull.sample + at) / 2).array();
      return held.minCoeff() * held.maxCoeff() > 0;
    });
    events.push_back({at, deviation[at], false});
    break;
  }
  std::sort(events.begin(), events.end(), [](const auto& a, const auto& b) { return a.sample < b.sample; });
}

std::optional<OffsetDrift> offset_drift(const VectorXd& signal, double period, double noise) {
  constexpr Index most_parts = 20, fewest_parts = 5, fewest_samples = 16;
  constexpr double share = 0.25, times_noise = 10;
  // Whole periods, so that the part of one that is left over shifts no mean.
  const double periods =
      period > 0 ? std::max(2.0, std::floor(static_cast<double>(signal.size()) / most_parts / period)) : 0;
  const Index length =
      std::max<Index>(fewest_samples, period > 0 ? static_cast<Index>(std::round(periods * period))
                                                 : signal.size() / most_parts);
  const Index parts = signal.size() / length;
  if (parts < fewest_parts) return {};
  std::vector<double> middles;
  for (Index part = 0; part < parts; ++part) middles.push_back(signal.segment(part * length, length).mean());
  const auto [low, high] = std::minmax_element(middles.begin(), middles.end());
  const double least = std::max(share * (signal.array() - median(signal)).abs().maxCoeff(),
                                times_noise * noise / std::sqrt(static_cast<double>(length)));
  if (!(*high - *low > least)) return {};
  OffsetDrift found{*low, *high, false, 0};
  const double end = median(
      std::vector<double>(middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2), middles.end()));
  Index settled = parts;
  while (settled > 0 && std::abs(middles[static_cast<std::size_t>(settled - 1)] - end) < 0.5 * least)
    --settled;
  found.start_up = settled > 0 && settled <= parts / 2;
  found.settled = settled * length;
  return found;
}

}  // namespace beamid::experiments
