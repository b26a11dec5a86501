#include "experiments/results/envelope.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace beamid::experiments {

std::vector<Eigen::Index> envelope(const Eigen::VectorXd& x, const Eigen::VectorXd& y, bool logarithmic,
                                   Eigen::Index limit) {
  const Eigen::Index size = x.size();
  std::vector<Eigen::Index> kept(static_cast<std::size_t>(size));
  std::iota(kept.begin(), kept.end(), Eigen::Index{0});
  const Eigen::Index intervals = std::max<Eigen::Index>(1, limit / 2), most = 3 * intervals + 2;
  if (size <= most) return kept;  // what this gives is not thinned again

  const auto drawn = [&](Eigen::Index i) { return logarithmic ? std::log(x[i]) : x[i]; };
  Eigen::Index first = 0;
  while (first < size - 1 && !std::isfinite(drawn(first))) ++first;
  const double start = drawn(first), width = drawn(size - 1) - start;
  const bool ascending = x.allFinite() && std::is_sorted(x.begin(), x.end()) && width > 0;
  const auto interval = [&](Eigen::Index i) {
    const double place =
        ascending ? (drawn(i) - start) / width : static_cast<double>(i) / static_cast<double>(size - 1);
    return std::clamp(static_cast<Eigen::Index>(std::max(place, 0.0) * static_cast<double>(intervals)),
                      Eigen::Index{0}, intervals - 1);
  };

  kept = {0};
  for (Eigen::Index begin = 0, end; begin < size; begin = end) {
    Eigen::Index low = begin, high = begin, gap = -1;
    for (end = begin; end < size && interval(end) == interval(begin); ++end) {
      if (!std::isfinite(y[end])) gap = end;
      if (!(y[low] <= y[end])) low = std::isfinite(y[end]) ? end : low;
      if (!(y[high] >= y[end])) high = std::isfinite(y[end]) ? end : high;
    }
    Eigen::Index chosen[] = {low, high, gap};
    std::sort(std::begin(chosen), std::end(chosen));
    for (const Eigen::Index i : chosen)
      if (i > kept.back()) kept.push_back(i);
  }
  if (kept.back() != size - 1) kept.push_back(size - 1);
  return kept;
}

}  // namespace beamid::experiments
