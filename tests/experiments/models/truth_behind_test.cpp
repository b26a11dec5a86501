// Oracles: the closed form forwards; forward Euler's g^-1 by hand.
#include "experiments/models/truth_behind.hpp"

#include <gtest/gtest.h>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/studies/paper/numerical_validation.hpp"

namespace beamid::experiments::truth_behind_test {
namespace {

class TruthBehind : public testing::TestWithParam<std::string> {};

TEST_P(TruthBehind, IsWhatTheClosedFormWasGiven) {
  for (const double ratio : {0.0, 0.0015, 0.02, 0.3})
    for (const double dt : {1e-3, 0.02}) {
      const Oscillator truth = Oscillator::from_frequency(3.0, 13.0, ratio),
                       found = seen_through(GetParam(), truth, dt),
                       behind = truth_behind(GetParam(), found, dt);
      EXPECT_NEAR(behind.stiffness / truth.stiffness, 1.0, 1e-11) << ratio << ", " << dt;
      EXPECT_NEAR(behind.damping_ratio(), ratio, 1e-11) << dt;
    }
}

TEST_P(TruthBehind, IsFoundFromTheRatioAtATrueFrequency) {
  constexpr double dt = 0.02, omega = 13.0, ratio = 0.02;
  const auto seen = [&](const Oscillator& truth) { return seen_through(GetParam(), truth, dt); };
  const double assumed = seen(Oscillator::from_frequency(1.0, omega, ratio)).damping_ratio();
  const Oscillator behind = truth_with_ratio(assumed, omega, seen);
  EXPECT_NEAR(behind.damping_ratio(), ratio, 1e-11);
  EXPECT_NEAR(behind.angular_frequency(), omega, 1e-11);
}

INSTANTIATE_TEST_SUITE_P(All, TruthBehind, testing::ValuesIn(paper::compared_schemes()),
                         [](const auto& tested) { return tested.param; });

// The 2009 paper's own example: 10 % behind C 6.41648 % too large and K 0.13244 % too small.
TEST(TruthBehindForwardEuler, OfThePapersTableIsTenPercent) {
  const Oscillator truth = paper::validation_truth();
  const Oscillator found{3.0, 515.8 * (1.0 - 0.00132439696829), truth.damping * 1.0641647580677};
  EXPECT_NEAR(truth_behind("forward_euler", found, 1e-3).damping_ratio(), 0.10, 1e-11);
}

TEST(TruthBehindForwardEuler, GrowsWhereNoDampedMotionIsSeenAsThat) {
  // |1 + lambda dt|^2 = 1 + (w dt)^2 - 2 xi w dt > 1 for xi < w dt / 2: the motion behind it grows.
  const Oscillator found = Oscillator::from_frequency(1.0, 10.0, 0.04);
  EXPECT_LT(truth_behind("forward_euler", found, 0.01).damping_ratio(), 0.0);
  EXPECT_GT(truth_behind("forward_euler", found, 0.007).damping_ratio(), 0.0);
}

TEST(TruthBehindForwardEuler, RefusesHalfAPeriodAndMotionThatDoesNotOscillate) {
  const Oscillator found = Oscillator::from_frequency(1.0, 10.0, 0.04);
  EXPECT_THROW(truth_behind("forward_euler", found, 0.4), std::invalid_argument);
  EXPECT_THROW(truth_behind("forward_euler", found, 0.0), std::invalid_argument);
  EXPECT_THROW(truth_behind("no_such_scheme", found, 0.01), std::invalid_argument);
  EXPECT_THROW(truth_behind("forward_euler", {1.0, 100.0, 40.0}, 0.01), std::invalid_argument);
}

TEST(TruthBehindForwardEuler, IsNotFoundForARatioThatNoStructureGives) {
  const auto never = [](const Oscillator&) { return Oscillator::from_frequency(1.0, 10.0, 0.9); };
  EXPECT_THROW(truth_with_ratio(0.1, 10.0, never), std::runtime_error);
}

}  // namespace
}  // namespace beamid::experiments::truth_behind_test
