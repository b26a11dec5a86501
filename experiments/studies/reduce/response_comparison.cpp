#include "experiments/studies/reduce/response_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

VectorXd response_grid(double from, double to, const std::vector<VectorXd>& angular_frequency,
                       const fem::DampingLaw& damping) {
  constexpr int even = 2000, beside = 120;  // points; beside: on each side of a resonance
  constexpr double turn = 2.0 * std::numbers::pi, farthest = 50.0, finest = 0.025;  // half-power half widths
  std::vector<double> grid;
  for (int i = 0; i <= even; ++i) grid.push_back(from * std::pow(to / from, static_cast<double>(i) / even));
  grid.back() = to;
  for (const VectorXd& omega : angular_frequency) {
    const VectorXd ratio = fem::damping_ratios(damping, omega);
    for (Index i = 0; i < omega.size(); ++i) {
      const double peak = omega[i] / turn;
      if (!(ratio[i] > 0.0) || peak < from || peak > to) continue;
      for (int k = -beside; k <= beside; ++k) {
        const double away = std::abs(static_cast<double>(k)) / beside;
        const double widths = finest * std::expm1(away * std::log(farthest / finest));
        const double at = peak * (1.0 + std::copysign(ratio[i] * widths, k));
        if (at > from && at < to) grid.push_back(at);
      }
    }
  }
  std::sort(grid.begin(), grid.end());
  grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
  return Eigen::Map<const VectorXd>(grid.data(), static_cast<Index>(grid.size()));
}

ResponseDifference compare_magnitudes(const VectorXd& frequency_hz, const VectorXd& full,
                                      const VectorXd& reduced) {
  const Index last = frequency_hz.size() - 1;
  const auto integral = [&](const VectorXd& values) {  // trapezoids
    const VectorXd steps = frequency_hz.tail(last) - frequency_hz.head(last);
    return 0.5 * steps.dot(values.head(last) + values.tail(last));
  };
  ResponseDifference found;
  found.relative = std::sqrt(integral((reduced - full).cwiseAbs2()) / integral(full.cwiseAbs2()));
  found.worst_hz = std::numeric_limits<double>::quiet_NaN();
  for (Index i = 0; i <= last; ++i) {
    const double decibels = 20.0 * std::log10(reduced[i] / full[i]);
    if (!(std::abs(decibels) > std::abs(found.worst_db)) || !std::isfinite(decibels)) continue;
    found.worst_db = decibels;
    found.worst_hz = frequency_hz[i];
  }
  return found;
}

}  // namespace beamid::experiments
