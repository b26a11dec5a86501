#include "experiments/record/inspect/signal_events.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/record/inspect/noise_floor.hpp"
#include "experiments/signal/median.hpp"

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
  Index free_from = 0;
  for (Index k = 1; k < size; ++k) {
    if (k < free_from || distance[k] <= level) continue;
    const Index from = std::max<Index>(0, k - window);
    const double before = distance.segment(from, k - from).maxCoeff();
    const Index ahead = std::min(window, size - k);
    Index peak = 0;
    const double after = distance.segment(k, ahead).maxCoeff(&peak);
    if (after <= rise * before) continue;
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

}  // namespace beamid::experiments
