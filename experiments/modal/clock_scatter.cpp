#include "experiments/modal/clock_scatter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/signal/chi_square_limit.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// Numbers, each with a deviation, that should be one.
struct Scatter {
  double mean = 0.0, squares = 0.0;  ///< squares of distances from the mean, in deviations
  double farthest = 0.0;             ///< distance from the mean, of those beyond two deviations
  Index freedom = 0;
};

Scatter scatter_of(const VectorXd& values, const VectorXd& deviations) {
  Scatter found;
  double weights = 0.0;
  for (Index i = 0; i < values.size(); ++i) {
    if (!std::isfinite(deviations[i]) || !(deviations[i] > 0.0)) continue;
    const double weight = std::pow(deviations[i], -2);
    found.mean += weight * values[i], weights += weight, ++found.freedom;
  }
  if (--found.freedom < 1) return {};
  found.mean /= weights;
  for (Index i = 0; i < values.size(); ++i)
    if (std::isfinite(deviations[i]) && deviations[i] > 0.0) {
      const double distance = std::abs(values[i] - found.mean);
      found.squares += std::pow(distance / deviations[i], 2);
      if (distance > 2.0 * deviations[i]) found.farthest = std::max(found.farthest, distance);
    }
  return found;
}

/// Of each channel, over its modes: relative to the joint frequencies, with its deviation.
std::pair<VectorXd, VectorXd> clock_rates(const JointDecayFit& fit) {
  const Index channels = fit.own_shift.rows();
  VectorXd rates = VectorXd::Zero(channels), deviations(channels);
  for (Index c = 0; c < channels; ++c) {
    double weights = 0.0;
    for (Index m = 0; m < fit.own_shift.cols(); ++m) {
      const double w = fit.rates[static_cast<std::size_t>(m)].imag(),
                   weight = std::pow(w / fit.own_shift_deviation(c, m), 2);
      if (!(weight > 0.0) || !std::isfinite(weight)) continue;
      rates[c] += weight * fit.own_shift(c, m) / w, weights += weight;
    }
    rates[c] /= std::max(weights, 1e-300);
    deviations[c] = 1.0 / std::sqrt(weights);
  }
  return {rates, deviations};
}

}  // namespace

std::optional<ClockScatter> clock_scatter(const JointDecayFit& fit) {
  constexpr double by_chance = 1e-4;
  ClockScatter found;
  found.farthest.resize(fit.own_shift.cols());
  for (Index m = 0; m < fit.own_shift.cols(); ++m) {
    const Scatter mode = scatter_of(fit.own_shift.col(m), fit.own_shift_deviation.col(m));
    found.chi_square += mode.squares, found.freedom += static_cast<double>(mode.freedom);
    found.farthest[m] = mode.farthest;
  }
  if (found.freedom < 1.0 || !(found.chi_square > chi_square_limit(found.freedom, 1.0 - by_chance)))
    return {};
  const auto [rates, deviations] = clock_rates(fit);
  // A clock that runs fast counts more seconds in which the structure rings slower.
  found.apart = rates.maxCoeff(&found.slow) - rates.minCoeff(&found.fast);
  found.deviation = std::hypot(deviations[found.fast], deviations[found.slow]);
  return found;
}

std::string ClockScatter::sentence(const std::vector<std::string>& channels) const {
  return fmt::format(
      "The channels do not ring at one frequency (chi^2 = {:.3g} of {:.0f}): {} runs {:.2g} ppm faster than "
      "{}, with a standard deviation of {:.2g}. Were they sampled by clocks of their own, or "
      "does another mode ring close by?",
      chi_square, freedom, channels[static_cast<std::size_t>(fast)], 1e6 * apart,
      channels[static_cast<std::size_t>(slow)], 1e6 * deviation);
}

}  // namespace beamid::experiments
