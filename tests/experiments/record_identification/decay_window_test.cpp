// The part of a record that is identified where nobody says which. Oracle: when the beam was released in the
// simulated record, and the time constant 1/(xi omega) it was made with.
#include "experiments/record_identification/decay_window.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/experiments/record_identification/simulated_record.hpp"

namespace beamid::experiments {
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
  const double believed_hz = std::sqrt(1.1) * simulated.mode.angular_frequency() / (2.0 * std::numbers::pi);
  const double time_constant = 1.0 / (damping_ratio * simulated.mode.angular_frequency());
  for (const auto& times : std::vector<std::vector<double>>{{1.0}, {0.5, 2.0}}) {
    const auto window = decay_window(experiment, released_at(times, 11));
    ASSERT_TRUE(window);
    EXPECT_NEAR(window->event, times.back(), 1.5 * interval);
    EXPECT_NEAR(window->from - window->event, 3.0 / believed_hz, 1e-3);
    EXPECT_NEAR(window->time_constant, time_constant, 0.01 * time_constant);
    EXPECT_NEAR(window->to - window->from, 2.0 * window->time_constant, 1e-9);
  }
}

TEST(DecayWindow, LeavesARecordAloneThatBeginsInMotion) {
  const test::SimulatedBeam simulated;
  EXPECT_FALSE(decay_window(simulated.experiment(), simulated.record({Quantity::acceleration}, 0.01, 12)));
}

TEST(DecayWindow, LeavesARecordAloneThatEndsTooSoonBehindItsEvent) {
  EXPECT_FALSE(decay_window(test::SimulatedBeam().experiment(), released_at({9.0}, 13)));
}

}  // namespace
}  // namespace beamid::experiments
