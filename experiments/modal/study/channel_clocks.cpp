#include "experiments/modal/study/channel_clocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

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

void compare_clocks(const JointDecayFit& fit, RecordModes& found) {
  constexpr double by_chance = 1e-4;
  std::vector<Scatter> modes;
  double squares = 0.0, freedom = 0.0;
  for (Index m = 0; m < fit.own_shift.cols(); ++m) {
    modes.push_back(scatter_of(fit.own_shift.col(m), fit.own_shift_deviation.col(m)));
    squares += modes.back().squares, freedom += static_cast<double>(modes.back().freedom);
  }
  if (freedom < 1.0 || !(squares > chi_square_limit(freedom, 1.0 - by_chance))) return;
  for (std::size_t m = 0; m < modes.size(); ++m) {
    double& deviation = found.modes[m].pole.frequency_deviation_hz;
    deviation = std::hypot(deviation, modes[m].farthest / (2.0 * std::numbers::pi));
  }
  const auto [rates, deviations] = clock_rates(fit);
  Index fast = 0, slow = 0;
  const double apart = rates.maxCoeff(&fast) - rates.minCoeff(&slow);
  const auto& channels = found.record.channels;
  found.warnings.push_back(fmt::format(
      "The channels do not ring at one frequency (chi^2 = {:.3g} of {:.0f}): {} runs {:.2g} ppm faster than "
      "{}, with a standard deviation of {:.2g}. Were they sampled by clocks of their own? A frequency cannot "
      "say "
      "which is right; its deviations are widened by how far its channels are from it.",
      squares, freedom, channels[static_cast<std::size_t>(slow)].name, 1e6 * apart,
      channels[static_cast<std::size_t>(fast)].name, 1e6 * std::hypot(deviations[fast], deviations[slow])));
}

}  // namespace beamid::experiments
