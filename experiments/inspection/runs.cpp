#include "experiments/inspection/runs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beamid::experiments {
namespace {

/// Neighbouring samples of one value; NaN is one value.
std::vector<Run> runs_of(const std::vector<double>& signal) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < signal.size(); ++i) {
    const bool same =
        i > 0 && (signal[i] == signal[i - 1] || (std::isnan(signal[i]) && std::isnan(signal[i - 1])));
    if (same)
      ++runs.back().length;
    else
      runs.push_back({i, 1, signal[i]});
  }
  return runs;
}

/// The smallest step between values that occur.
double smallest_step(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  std::sort(values.begin(), values.end());
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] > values[i - 1]) step = std::min(step, values[i] - values[i - 1]);
  return step;
}

}  // namespace

std::vector<Run> clipped_runs(const std::vector<double>& signal) {
  constexpr std::size_t shortest = 3;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : signal)
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  std::vector<Run> clipped;
  if (!(high > low)) return clipped;
  const double jump = 4 * smallest_step(signal);
  const auto far = [&](std::size_t sample, double value) { return std::abs(signal[sample] - value) >= jump; };
  for (const Run& run : runs_of(signal)) {
    if (run.length < shortest || (run.value != low && run.value != high)) continue;
    const std::size_t after = run.first + run.length;
    if ((run.first > 0 && far(run.first - 1, run.value)) || (after < signal.size() && far(after, run.value)))
      clipped.push_back(run);
  }
  return clipped;
}

std::vector<Run> dropped_runs(const std::vector<double>& signal) {
  constexpr double shortest = 8.0, beyond_chance = 3.0;
  const std::vector<Run> runs = runs_of(signal);
  std::vector<Run> dropped;
  if (runs.size() < 2) return runs.size() == 1 && std::isnan(runs[0].value) ? runs : dropped;
  // Long runs would explain themselves: the share of repetitions is that of the shorter half of them.
  double repeated = 0.0, samples = 0.0;
  for (const Run& run : runs)
    if (static_cast<double>(run.length) < shortest)
      repeated += static_cast<double>(run.length - 1), samples += static_cast<double>(run.length);
  const double share = std::clamp(repeated / std::max(samples, 1.0), 1e-6, 0.95);
  const double chance = std::log(static_cast<double>(signal.size())) / std::log(1 / share);
  for (const Run& run : runs)
    if (std::isnan(run.value) ||
        static_cast<double>(run.length) >= std::max(shortest, beyond_chance * chance))
      dropped.push_back(run);
  return dropped;
}

}  // namespace beamid::experiments
