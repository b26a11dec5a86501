#include "experiments/record/inspect/offset_drift.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "experiments/signal/median.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

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
