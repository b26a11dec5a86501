#include "experiments/signal/shifted.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "experiments/signal/band_limited.hpp"
#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

VectorXd shifted(const VectorXd& time, const VectorXd& signal, double by) {
  if (by == 0.0) return signal;
  constexpr Index margin = 16;  // the interpolation's reach
  const Index count = time.size();
  if (signal.array().isFinite().count() < 4)
    throw std::invalid_argument("fewer than four samples; expected a signal to shift");
  const BandLimited between(time, bridged_straight(signal));
  VectorXd missing_before = VectorXd::Zero(count + 1);  // how many of the first k samples are not there
  for (Index k = 0; k < count; ++k)
    missing_before[k + 1] = missing_before[k] + (std::isfinite(signal[k]) ? 0.0 : 1.0);
  VectorXd result = VectorXd::Constant(count, std::numeric_limits<double>::quiet_NaN());
  std::vector<Index> kept;
  for (Index k = 0; k < count; ++k) {
    const auto next = std::upper_bound(time.begin(), time.end(), time[k] + by) - time.begin();
    if (next < margin || next + margin > count) continue;
    if (missing_before[next + margin] == missing_before[next - margin]) kept.push_back(k);
  }
  if (kept.empty()) return result;
  result(kept) = between(time(kept).array() + by);
  return result;
}

}  // namespace beamid::experiments
