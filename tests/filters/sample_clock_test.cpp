// Intervals between stamps. Oracle: the contract of SampleClock.
#include "filters/sample_clock.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace beamid::sample_clock_test {
namespace {

using filters::SampleClock;

TEST(SampleClock, TakesRoundedStampsToBeRegularHoweverManyThereAre) {
  const double dt = 1.0 / 3000.0;
  SampleClock clock(dt);
  clock.start(1e4);
  for (int k = 1; k < 300000; ++k) ASSERT_EQ(clock.advance(1e4 + k * dt), dt) << k;
}

TEST(SampleClock, MeasuresGapsAndGoesOnRegularly) {
  SampleClock clock(0.1);
  clock.start(0.0);
  EXPECT_EQ(clock.advance(0.1), 0.1);
  EXPECT_NEAR(clock.advance(0.73), 0.63, 1e-15);
  EXPECT_EQ(clock.advance(0.83), 0.1);
}

TEST(SampleClock, KeepsPrintedStampsOnTheGrid) {
  // 1/300 s printed with three decimals: none is off by more than half a millisecond.
  SampleClock clock(1.0 / 300.0, 5.001e-4);
  clock.start(0.0);
  for (const double stamp : {0.003, 0.007, 0.010, 0.013, 0.017, 0.020})
    EXPECT_EQ(clock.advance(stamp), 1.0 / 300.0);
  EXPECT_NEAR(clock.advance(0.030), 0.010, 1e-15);
}

TEST(SampleClock, NeverGoesBack) {
  SampleClock clock(1.0, 0.4);
  clock.start(0.0);
  EXPECT_EQ(clock.advance(0.7), 1.0);
  EXPECT_NEAR(clock.advance(0.9), 0.2, 1e-15);
  EXPECT_THROW(clock.advance(0.9), std::invalid_argument);
  EXPECT_THROW(clock.advance(std::numeric_limits<double>::infinity()), std::invalid_argument);
  EXPECT_THROW(SampleClock(0.0), std::invalid_argument);
  EXPECT_THROW(SampleClock(1.0, 0.5), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::sample_clock_test
