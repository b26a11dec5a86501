#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <numbers>

#include "experiments/studies/steps/steps.hpp"
#include "filters/scheme.hpp"

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
  const auto method = filters::scheme_registry().make(scheme, {});
  const auto missing = [&](double size) {
    const std::complex<double> z = std::polar(size, 1.0);
    return std::abs(std::exp(z) - method->amplification(z).value);
  };
  constexpr double size = 0.05, rounding = 1e-14;
  const double small = missing(size), twice = missing(2.0 * size);
  if (small < rounding) return 0;
  return static_cast<int>(std::lround(std::log2(twice / small))) - 1;
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
