// Slow motion beneath an oscillation. Oracle: the transform of the Hann window, sin(x pi) / (x pi) / (1 -
// x^2).
#include "experiments/signal/sway.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
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

// Oracle: the motion itself, with and without its mean.
TEST(Sway, ChangesADecayByItsResponse) {
  const std::complex<double> rate(-1.3, tau * 4.1);
  DecimatedSignal decay = sine(1);
  for (Eigen::Index k = 0; k < decay.samples.size(); ++k)
    decay.samples[k] = std::exp(rate * (interval * static_cast<double>(k))).real();
  const DecimatedSignal left = without_sway(decay, period);
  const std::complex<double> response = response_without_sway(rate, interval, period);
  for (Eigen::Index k = 0; k < left.samples.size(); k += 100)
    EXPECT_NEAR(left.samples[k],
                (response * std::exp(rate * (left.start + interval * static_cast<double>(k)))).real(), 1e-12);
}

// Oracle: root mean squares: of a line 1 / sqrt(12) of its range, of which windows between 1.5 and 8.5 of ten
// periods show 0.7, and of the sine 1 / sqrt(2).
TEST(Sway, IsADriftWhereItTurnsThreeTimesAtMost) {
  const VectorXd motion = sine(5).samples, line = VectorXd::LinSpaced(motion.size(), 0, 1);
  EXPECT_LT(drift_beneath(motion, interval, period).share, 1e-3);
  const Drift drift = drift_beneath(motion + line, interval, period);
  EXPECT_NEAR(drift.share, 0.7 * std::sqrt(2.0 / 12.0), 0.03);
  EXPECT_LT(drift.steepness, 0.6);
  EXPECT_EQ(drift_beneath(motion + sine(2.0).samples, interval, period).share, 0.0);  // a slow mode
  VectorXd held = motion;
  held.head(900).array() += 3.0;
  EXPECT_GT(drift_beneath(held, interval, period).steepness, 0.9);
  EXPECT_EQ(drift_beneath(motion.head(1500), interval, period).share, 0.0);  // shorter than ten periods
}

TEST(Sway, OfASignalShorterThanTheWindowIsNotSought) {
  DecimatedSignal one = sine(5);
  one.samples = one.samples.head(400).eval();
  EXPECT_EQ(sway(one, period).size(), 0);
  EXPECT_EQ(without_sway(one, period).samples.size(), 400);
}

}  // namespace
}  // namespace beamid::experiments::sway_test
