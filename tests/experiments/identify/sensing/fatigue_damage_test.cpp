// Rainflow cycles and the damage they do.
#include "experiments/identify/sensing/fatigue_damage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace beamid::fatigue_damage_test {
namespace {

using namespace experiments;
using Eigen::Index, Eigen::VectorXd;

double count_of(const std::vector<StrainCycle>& cycles, double range) {
  double count = 0.0;
  for (const StrainCycle& cycle : cycles)
    if (std::abs(cycle.range - range) < 1e-12) count += cycle.count;
  return count;
}

TEST(Rainflow, CountsTheExampleOfTheStandard) {
  // Oracle: ASTM E1049-85, section 5.4.4: -2 1 -3 5 -1 3 -4 4 -2 has half cycles of 3, 4, 6, 8, 8, 9 and a
  // whole one of 4.
  VectorXd history(9);
  history << -2, 1, -3, 5, -1, 3, -4, 4, -2;
  const std::vector<StrainCycle> cycles = rainflow(history);
  EXPECT_EQ(count_of(cycles, 3), 0.5);
  EXPECT_EQ(count_of(cycles, 4), 1.5);
  EXPECT_EQ(count_of(cycles, 6), 0.5);
  EXPECT_EQ(count_of(cycles, 8), 1.0);
  EXPECT_EQ(count_of(cycles, 9), 0.5);
}

TEST(Rainflow, ClosesASmallCycleWithinALargeOne) {
  VectorXd history(6);
  history << 0, 10, 4, 6, -10, 10;
  const std::vector<StrainCycle> cycles = rainflow(history);
  EXPECT_EQ(count_of(cycles, 2), 1.0);
  EXPECT_EQ(count_of(cycles, 20), 1.0);
}

TEST(FatigueDamage, OfASineIsThatOfItsRange) {
  // Oracle: n cycles of one range r do n (r / r_0)^m / N_0. The first and the last quarter have half of it.
  const VectorXd t = VectorXd::LinSpaced(100001, 0.0, 100.0);
  const VectorXd history = 1e-4 * (2.0 * std::numbers::pi * t.array()).sin();
  const FatigueDamage found = fatigue_damage(history, {5.0, 4e-4, 2e6});
  EXPECT_NEAR(found.damage, 100.0 * std::pow(0.5, 5) / 2e6, 0.01 * found.damage);
  EXPECT_NEAR(found.equivalent_range, 2e-4, 3e-3 * 2e-4);
}

TEST(FatigueDamage, OfANarrowBandIsTheClosedFormula) {
  // Oracle: Bendat's formula. 60,000 periods of an oscillator at 0.4 % damping: ranges follow its Rayleigh
  // distribution, of (range)^4 the mean is known to about 1 % from the correlated 240 independent parts.
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const double w = 2.0 * std::numbers::pi / 32.0, decay = std::exp(-0.004 * w);
  double x = 0.0, y = 0.0;
  VectorXd history(32 * 60000);
  for (double& one : history) {  // rotation, slow change of amplitude and phase
    const double moved = decay * (std::cos(w) * x - std::sin(w) * y) + normal(random);
    y = decay * (std::sin(w) * x + std::cos(w) * y) + normal(random);
    x = moved;
    one = 1e-6 * x;
  }
  const FatigueDamage found = fatigue_damage(history, {4.0, 4e-4, 2e6});
  EXPECT_NEAR(found.narrow_band / found.damage, 1.0, 0.02);
}

}  // namespace
}  // namespace beamid::fatigue_damage_test
