// Oracle: the envelope and the offset that the signal was made with.
#include "experiments/signal/sway.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace beamid::experiments::local_motion_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double interval = 0.01, frequency = 3.0;

TEST(LocalMotion, FollowsADecayThroughADrift) {
  constexpr double damping = 0.05;
  const VectorXd time = VectorXd::LinSpaced(2001, 0, 20),
                 signal = 2 * (-damping * time).array().exp() *
                              (2 * std::numbers::pi * frequency * time).array().sin() +
                          0.3 * time.array();
  const LocalMotion motion = local_motion(signal, interval, frequency);
  ASSERT_GT(motion.time.size(), 200);
  EXPECT_NEAR(motion.time[1] - motion.time[0], 0.25 / frequency, interval);
  for (Index k = 0; k < motion.time.size(); ++k) {
    EXPECT_NEAR(motion.amplitude[k], 2 * std::exp(-damping * motion.time[k]), 2e-3);
    EXPECT_NEAR(motion.offset[k], 0.3 * motion.time[k], 0.02);
  }
}

TEST(LocalMotion, SeesMostOfAFrequencyThatIsAQuarterOff) {
  const VectorXd time = VectorXd::LinSpaced(2001, 0, 20);
  for (const double off : {0.75, 1.25}) {
    const LocalMotion motion =
        local_motion((2 * std::numbers::pi * off * frequency * time).array().sin(), interval, frequency);
    EXPECT_GT(motion.amplitude.minCoeff(), 0.5);
    EXPECT_LT(motion.amplitude.maxCoeff(), 1.5);
  }
}

TEST(LocalMotion, IsEmptyWhereThereIsNoWindow) {
  EXPECT_EQ(local_motion(VectorXd::Ones(20), interval, frequency).time.size(), 0);
  EXPECT_EQ(local_motion(VectorXd::Ones(2000), interval, 30).time.size(), 0);
}

}  // namespace
}  // namespace beamid::experiments::local_motion_test
