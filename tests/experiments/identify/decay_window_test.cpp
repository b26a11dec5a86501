// The part of a record that is identified where nobody says which. Oracle: when the beam was released in the
// simulated record, and the time constant 1/(xi omega) it was made with.
#include "experiments/identify/engine/identification_request.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/experiments/identify/simulated_record.hpp"

namespace beamid::experiments::decay_window_test {
namespace {

using Eigen::Index;

constexpr double interval = 0.005, damping_ratio = 0.02;

/// The releases [s], each four times larger than the last, of a beam that nobody touches before the first.
Record released_at(const std::vector<double>& times, std::uint64_t seed) {
  test::SimulatedBeam simulated;
  simulated.damping_ratio = damping_ratio;
  const Record noise = simulated.record({Quantity::acceleration}, 0.001, seed);
  const Eigen::RowVectorXd decay = simulated.record({Quantity::acceleration}, 0.0, seed).samples;
  Record record = noise;
  record.samples -= decay;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const auto begin = static_cast<Index>(std::lround(times[k] / interval));
    record.samples.row(0).tail(record.size() - begin) +=
        std::pow(4.0, static_cast<double>(k)) * decay.head(record.size() - begin);
  }
  return record;
}

TEST(DecayWindow, BeginsThreePeriodsBehindTheLastEventAndSpansTwoTimeConstants) {
  const test::SimulatedBeam simulated;
  const Experiment experiment = simulated.experiment();
  const double described_hz = std::sqrt(1.1) * simulated.mode.angular_frequency() / (2.0 * std::numbers::pi);
  const double time_constant = 1.0 / (damping_ratio * simulated.mode.angular_frequency());
  for (const auto& times : std::vector<std::vector<double>>{{1.0}, {0.5, 2.0}}) {
    const auto window = decay_window(experiment, released_at(times, 11));
    ASSERT_TRUE(window);
    EXPECT_NEAR(window->event, times.back(), 1.5 * interval);
    EXPECT_NEAR(window->from - window->event, 3.0 / described_hz, 1e-3);
    EXPECT_NEAR(window->time_constant, time_constant, 0.01 * time_constant);
    EXPECT_NEAR(window->to - window->from, 2.0 * window->time_constant, 1e-9);
  }
}

/// What a sensor adds that starts up: three times the motion, fading in 0.2 s.
void start_up(Record& record) {
  const double largest = record.samples.row(0).cwiseAbs().maxCoeff();
  record.samples.row(0).array() += 3 * largest * (-record.time.transpose().array() / 0.2).exp();
}

TEST(DecayWindow, TakesNoStartUpForAnEvent) {
  const test::SimulatedBeam simulated;
  const double period = 2 * std::numbers::pi / simulated.mode.angular_frequency();
  Record released = released_at({2.0}, 14);
  start_up(released);
  const auto window = decay_window(simulated.experiment(), released);
  ASSERT_TRUE(window);
  EXPECT_EQ(window->behind, DecayWindow::Behind::event);
  EXPECT_NEAR(window->event, 2.0, 1.5 * period);
}

// In motion from the first sample: behind the start-up, which is below 3 % from ln(3 / 0.03) 0.2 s on at
// most.
TEST(DecayWindow, WaitsForASensorToSettle) {
  const test::SimulatedBeam simulated;
  Record moving = simulated.record({Quantity::acceleration}, 0.01, 15);
  start_up(moving);
  const auto window = decay_window(simulated.experiment(), moving);
  ASSERT_TRUE(window);
  EXPECT_EQ(window->behind, DecayWindow::Behind::start_up);
  EXPECT_GT(window->from, 0.2 * std::log(3 / 0.03));
  EXPECT_LT(window->event, 0.92 + 2 * 2 * std::numbers::pi / simulated.mode.angular_frequency());
}

// Half a second is missing behind the release: what is left before it is too short.
TEST(DecayWindow, BeginsBehindAGapThatTheMotionGoesThrough) {
  const test::SimulatedBeam simulated;
  const Record whole = released_at({0.5}, 17);
  const auto after = Index(std::lround(1.5 / interval)), before = Index(std::lround(1.0 / interval));
  Record gap = whole;
  gap.time.resize(before + whole.size() - after);
  gap.samples.resize(1, gap.time.size());
  gap.time << whole.time.head(before), whole.time.tail(whole.size() - after);
  gap.samples << whole.samples.leftCols(before), whole.samples.rightCols(whole.size() - after);
  const auto window = decay_window(simulated.experiment(), gap);
  ASSERT_TRUE(window);
  EXPECT_EQ(window->behind, DecayWindow::Behind::gap);
  EXPECT_NEAR(window->event, 1.5, 2 * interval);
}

// The motion comes up over three periods, as no sample of a hit or of a sudden release does.
TEST(DecayWindow, BeginsBehindASlowRelease) {
  const test::SimulatedBeam simulated;
  const double period = 2 * std::numbers::pi / simulated.mode.angular_frequency(), released = 2.0;
  Record record = released_at({0.0}, 16);
  for (Index k = 0; k < record.size(); ++k) {
    const double passed = std::clamp((record.time[k] - released) / (3 * period), 0.0, 1.0);
    record.samples(0, k) *= 0.5 * (1 - std::cos(std::numbers::pi * passed));
  }
  const auto window = decay_window(simulated.experiment(), record);
  ASSERT_TRUE(window);
  EXPECT_GT(window->event, released);
  EXPECT_LT(window->event, released + 5 * period);
  EXPECT_GT(window->from, released + 3 * period);
  EXPECT_NEAR(window->time_constant, period / (2 * std::numbers::pi * damping_ratio),
              0.02 * window->time_constant);
}

TEST(DecayWindow, LeavesARecordAloneThatBeginsInMotion) {
  const test::SimulatedBeam simulated;
  EXPECT_FALSE(decay_window(simulated.experiment(), simulated.record({Quantity::acceleration}, 0.01, 12)));
}

TEST(DecayWindow, LeavesARecordAloneThatEndsTooSoonBehindItsEvent) {
  EXPECT_FALSE(decay_window(test::SimulatedBeam().experiment(), released_at({9.0}, 13)));
}

}  // namespace
}  // namespace beamid::experiments::decay_window_test
