#include "experiments/record/inspect/defects.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "experiments/record/inspect/noise_floor.hpp"
#include "experiments/record/inspect/value_steps.hpp"
#include "experiments/signal/median.hpp"
#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

void leave_out(const std::vector<Run>& runs, std::vector<double>& samples) {
  for (const Run& run : runs)
    std::fill_n(samples.begin() + static_cast<std::ptrdiff_t>(run.first), run.length,
                std::numeric_limits<double>::quiet_NaN());
}

bool is_dead(const std::vector<double>& samples) {
  constexpr double far_larger = 1e3, out_of_reach = 1e4, noise_only = 2;
  constexpr Index fewest = 64;
  std::vector<double> finite;
  for (const double value : samples)
    if (std::isfinite(value)) finite.push_back(value);
  if (finite.empty() ||
      *std::max_element(finite.begin(), finite.end()) == *std::min_element(finite.begin(), finite.end()))
    return true;
  const Eigen::Map<const VectorXd> signal(finite.data(), static_cast<Index>(finite.size()));
  const double middle = median(finite), power = (signal.array() - middle).square().mean();
  if (std::abs(middle) > out_of_reach * std::sqrt(power)) return true;
  if (signal.size() < fewest || !(std::abs(middle) > far_larger * std::sqrt(power))) return false;
  const double noise = noise_floor(signal);
  return power < noise_only * noise * noise;
}

}  // namespace

Defects find_defects(const std::vector<double>& samples, SignalKind kind) {
  Defects found;
  if (kind == SignalKind::force) {
    found.clipped = clipped_runs(samples);
    return found;
  }
  std::vector<double> left = samples;
  found.spikes = spikes(left);
  leave_out(found.spikes, left);
  found.dead = is_dead(left);
  if (found.dead) return found;
  found.clipped = clipped_runs(left);
  leave_out(found.clipped, left);
  found.dropped = dropped_runs(left);
  std::erase_if(found.dropped, [&](const Run& run) {  // what was left out above is told there
    return std::isnan(run.value) && !std::isnan(samples[run.first]);
  });
  leave_out(found.dropped, left);
  found.repeated = repeated_samples(left);
  leave_out(found.repeated, left);
  const VectorXd signal = bridged_straight(Eigen::Map<const VectorXd>(left.data(), std::ssize(left)));
  found.rattle = find_rattle(signal, ValueSteps(left).near(signal.maxCoeff()));
  return found;
}

}  // namespace beamid::experiments
