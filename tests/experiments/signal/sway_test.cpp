// Slow motion beneath an oscillation. Oracle: the transform of the Hann window, sin(x pi) / (x pi) / (1 -
// x^2).
#include "experiments/signal/sway.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace beamid::experiments::sway_test {
namespace {

using Eigen::VectorXd;

constexpr double interval = 0.001, period = 0.2, tau = 2 * std::numbers::pi;

DecimatedSignal sine(double hz) {
  const VectorXd time = VectorXd::LinSpaced(2001, 0, 2);
  return {(tau * hz * time.array()).sin(), interval, 0, 1, {}};
}

TEST(Sway, IsLeftByTheWindowsTransform) {
  for (const double hz : {0.6, 1.7, 3.3, 5.0, 8.2}) {
    const double x = hz * 2 * period,
                 gain = std::abs(x - 2) < 1e-9
                            ? 0
                            : std::sin(x * std::numbers::pi) / (x * std::numbers::pi) / (1 - x * x);
    const DecimatedSignal before = sine(hz), left = without_sway(before, period);
    EXPECT_DOUBLE_EQ(left.start, period);
    ASSERT_EQ(left.samples.size(), 2001 - 400);
    const VectorXd expected = (1 - gain) * before.samples.segment(200, left.samples.size());
    EXPECT_LT((left.samples - expected).cwiseAbs().maxCoeff(), 1e-4) << hz;
  }
}

TEST(Sway, OfASignalShorterThanTheWindowIsNotSought) {
  DecimatedSignal one = sine(5);
  one.samples = one.samples.head(400).eval();
  EXPECT_EQ(sway(one, period).size(), 0);
  EXPECT_EQ(without_sway(one, period).samples.size(), 400);
}

}  // namespace
}  // namespace beamid::experiments::sway_test
