#include "experiments/record/rounded_stamps.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {

std::optional<EvenStamps> without_rounding(const std::vector<double>& times, double resolution) {
  // Rounding is half a resolution at most; 0.57 is the most that a line through 200 records left.
  constexpr double most_off = 0.65, none_off = 1e-6, least = 2e-3;
  const std::size_t size = times.size();
  if (size < 3) return std::nullopt;
  std::vector<double> steps;
  for (std::size_t k = 1; k < size; ++k) steps.push_back(times[k] - times[k - 1]);
  const double usual = median(steps);
  if (!(resolution > least * usual && resolution < 0.5 * usual)) return std::nullopt;
  std::vector<double> count{0.0};
  for (const double step : steps) count.push_back(count.back() + std::max(std::round(step / usual), 1.0));

  double mean_count = 0.0, mean_time = 0.0, squares = 0.0, products = 0.0;
  for (std::size_t k = 0; k < size; ++k) {
    mean_count += count[k] / static_cast<double>(size);
    mean_time += (times[k] - times[0]) / static_cast<double>(size);
  }
  for (std::size_t k = 0; k < size; ++k) {
    squares += (count[k] - mean_count) * (count[k] - mean_count);
    products += (count[k] - mean_count) * (times[k] - times[0] - mean_time);
  }
  EvenStamps line{{}, products / squares};
  double off = 0.0;
  for (std::size_t k = 0; k < size; ++k) {
    line.times.push_back(times[0] + mean_time + (count[k] - mean_count) * line.interval);
    off = std::max(off, std::abs(times[k] - line.times[k]));
  }
  if (off > most_off * resolution || off < none_off * resolution) return std::nullopt;
  return line;
}

}  // namespace beamid::experiments
