#include "experiments/identify/sensing/fatigue_damage.hpp"

#include <cmath>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

// First and last value, and where the history turns.
std::vector<double> turning_points(const VectorXd& history) {
  std::vector<double> points;
  for (const double value : history) {
    if (!points.empty() && value == points.back()) continue;
    if (points.size() >= 2 && (value > points.back()) == (points.back() > points[points.size() - 2]))
      points.back() = value;
    else
      points.push_back(value);
  }
  return points;
}

StrainCycle cycle_between(double a, double b, double count) {
  return {std::abs(a - b), 0.5 * (a + b), count};
}

double crossings_upward(const VectorXd& history, double level) {
  double count = 0.0;
  for (Index k = 0; k + 1 < history.size(); ++k)
    if (history[k] <= level && history[k + 1] > level) ++count;
  return count;
}

}  // namespace

std::vector<StrainCycle> rainflow(const VectorXd& history) {
  std::vector<StrainCycle> cycles;
  std::vector<double> stack;
  for (const double point : turning_points(history)) {
    stack.push_back(point);
    while (stack.size() >= 4) {
      const std::size_t n = stack.size();
      const double a = stack[n - 4], b = stack[n - 3], c = stack[n - 2], d = stack[n - 1];
      if (std::abs(b - c) > std::abs(a - b) || std::abs(b - c) > std::abs(c - d)) break;
      cycles.push_back(cycle_between(b, c, 1.0));
      stack.erase(stack.end() - 3, stack.end() - 1);
    }
  }
  for (std::size_t i = 0; i + 1 < stack.size(); ++i)
    cycles.push_back(cycle_between(stack[i], stack[i + 1], 0.5));
  return cycles;
}

FatigueDamage fatigue_damage(const VectorXd& history, const FatigueLaw& law) {
  FatigueDamage result;
  double sum = 0.0;
  for (const StrainCycle& cycle : rainflow(history)) {
    result.cycles += cycle.count;
    sum += cycle.count * std::pow(cycle.range / law.strain_range, law.exponent);
  }
  result.damage = sum / law.cycles;
  if (result.cycles > 0.0)
    result.equivalent_range = law.strain_range * std::pow(sum / result.cycles, 1.0 / law.exponent);
  const double mean = history.mean();
  const double sigma = std::sqrt((history.array() - mean).square().mean());
  result.narrow_band = crossings_upward(history, mean) *
                       std::pow(2.0 * std::sqrt(2.0) * sigma / law.strain_range, law.exponent) *
                       std::tgamma(1.0 + 0.5 * law.exponent) / law.cycles;
  return result;
}

}  // namespace beamid::experiments
