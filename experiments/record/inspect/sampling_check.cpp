#include "experiments/record/inspect/sampling_check.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/signal/median.hpp"

namespace beamid::experiments {

SamplingCheck check_sampling(const std::vector<double>& times, double resolution) {
  if (times.size() < 2) throw std::invalid_argument("fewer than two instants; expected at least two");
  std::vector<double> intervals;
  for (std::size_t i = 1; i < times.size(); ++i) intervals.push_back(times[i] - times[i - 1]);
  SamplingCheck check;
  check.interval = median(intervals);
  const double tolerated = 0.05 * check.interval + 1.01 * resolution;
  std::vector<double> from_median;
  for (const double interval : intervals) from_median.push_back(std::abs(interval - check.interval));
  const double scatter = median(from_median) / check.interval;  // where stamps jitter, late ones are no gaps
  const double late = (scatter > 0.05 ? 2.5 : 1.5) * check.interval + 1.01 * resolution;
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const double interval = intervals[i];
    if (interval == 0) {
      check.repeats.push_back(i + 1);
    } else if (interval < 0) {
      check.returns.push_back(i + 1);
    } else if (interval > late) {
      check.gaps.push_back(i + 1);
      check.longest_gap = std::max(check.longest_gap, interval);
    } else {
      sum += interval, count += 1.0;
    }
    check.uniform = check.uniform && std::abs(interval - check.interval) <= tolerated;
  }
  const double mean = sum / std::max(count, 1.0);
  for (const double interval : intervals)
    if (interval > 0 && interval <= late) check.jitter += (interval - mean) * (interval - mean);
  check.jitter = std::sqrt(check.jitter / std::max(count, 1.0));
  return check;
}

}  // namespace beamid::experiments
