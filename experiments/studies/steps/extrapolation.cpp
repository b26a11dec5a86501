#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "experiments/studies/steps/steps.hpp"
#include "filters/scheme_bias.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

// f0 of f0 + a dt^p + b dt^(p+1) + ... through all of them.
FoundMode at_zero(const std::vector<double>& intervals, const std::vector<FoundMode>& found, int order) {
  const auto n = static_cast<Index>(found.size());
  Eigen::MatrixXd powers(n, n), values(n, 2);
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double step = intervals[at] / intervals.back();
    for (Index j = 0; j < n; ++j)
      powers(i, j) = j == 0 ? 1.0 : std::pow(step, static_cast<double>(order + j - 1));
    values.row(i) << found[at].frequency_hz, found[at].damping_ratio;
  }
  const Eigen::RowVector2d limit = powers.fullPivLu().solve(values).row(0);
  return FoundMode{limit[0], limit[1]};
}

}  // namespace

int order_of(const std::string& scheme) {
  constexpr int highest = 8;
  const std::vector<double> series =
      filters::bias_series(*filters::scheme_registry().make(scheme, {}), highest);
  for (std::size_t k = 0; k < series.size(); ++k)
    if (series[k] != 0.0) return static_cast<int>(k) + 1;
  return 0;
}

std::optional<Extrapolation> StepsStudy::extrapolated(std::size_t discretisation) const {
  constexpr std::size_t most = 4;
  constexpr double largest_step = 1.0;  // [rad]: beyond, the series is no help
  std::vector<double> intervals;
  std::vector<FoundMode> found;
  for (const RecordAtStep& step : steps) {
    const SchemeAtStep& one = step.found.at(discretisation);
    if (!one.is_valid() || found.size() == most ||
        2.0 * std::numbers::pi * one.found->frequency_hz * step.interval > largest_step)
      continue;
    intervals.push_back(step.interval);
    found.push_back(*one.found);
  }
  const int order = order_of(discretisations.at(discretisation));
  if (found.size() < 2 || order == 0) return {};
  const FoundMode limit = at_zero(intervals, found, order);
  intervals.pop_back();
  found.pop_back();
  const double without_longest = at_zero(intervals, found, order).damping_ratio;
  return Extrapolation{order, static_cast<int>(found.size()) + 1, limit.frequency_hz, limit.damping_ratio,
                       std::abs(limit.damping_ratio - without_longest)};
}

}  // namespace beamid::experiments
