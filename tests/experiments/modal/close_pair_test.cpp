// Two modes nearer than a line of the record, and one mode that follows its amplitude. Oracle: what was
// simulated.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "experiments/modal/close_pair.hpp"
#include "experiments/modal/study/modal_study.hpp"
#include "experiments/signal/toolbox.hpp"
#include "tests/experiments/modal/nonlinear_decay.hpp"

namespace beamid::experiments::close_pair_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double pi = std::numbers::pi, interval = 0.005, ratio = 0.00318;
constexpr Index count = 4000;

/// 5 and 5 (1 + apart) Hz; in a second channel the sum becomes a difference.
Record pair(double apart, int channels, double noise, std::uint64_t seed) {
  Record record;
  record.time = VectorXd::LinSpaced(count, 0.0, interval * static_cast<double>(count - 1));
  record.samples.resize(channels, count);
  for (int c = 0; c < channels; ++c) {
    record.channels.push_back({Quantity::acceleration, c == 0 ? "a" : "b"});
    record.samples.row(c) = noise * standard_normal(count, seed, static_cast<std::uint64_t>(c)).transpose();
    for (Index k = 0; k < count; ++k) {
      const double first = 2.0 * pi * 5.0 * record.time[k], second = (1.0 + apart) * first;
      record.samples(c, k) += std::exp(-ratio * first) * std::sin(first) +
                              (c == 0 ? 1.0 : -0.7) * std::exp(-ratio * second) * std::sin(second);
    }
  }
  return record;
}

struct Case {
  double apart;
  int channels;
};

class TwoModes : public testing::TestWithParam<Case> {};

TEST_P(TwoModes, AreFound) {
  const auto [apart, channels] = GetParam();
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const RecordModes found = find_modes("pair", pair(apart, channels, 0.01, seed), false, {});
    ASSERT_EQ(found.modes.size(), 2U) << "seed " << seed;
    for (std::size_t m = 0; m < 2; ++m) {
      const Pole& pole = found.modes[m].pole;
      EXPECT_LT(std::abs(pole.frequency_hz() - 5.0 * (1.0 + (m == 1 ? apart : 0.0)) * std::hypot(1.0, ratio)),
                4.0 * pole.frequency_deviation_hz);
      EXPECT_LT(std::abs(pole.damping_ratio() - ratio), 4.0 * pole.damping_ratio_deviation);
      EXPECT_LT(pole.damping_ratio_deviation, 0.02 * ratio);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Apart, TwoModes,
                         testing::Values(Case{0.005, 1}, Case{0.01, 1}, Case{0.02, 1}, Case{0.005, 2},
                                         Case{0.01, 2}, Case{0.02, 2}));

// 0.3 beats in the record: two sensors separate them, as one drift in both cannot follow two shapes; of one
// sensor the two stand, or the mode has an objection.
TEST(ThreeTenthsOfABeat, AreTwoModesOrAnObjection) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const int channels : {1, 2}) {
      const RecordModes found = find_modes("pair", pair(0.003, channels, 0.01, seed), false, {});
      const bool objected = std::any_of(
          found.objections.begin(), found.objections.end(),
          [](const auto& one) { return one.name == "close_modes" || one.name == "drift_or_pair"; });
      EXPECT_TRUE(found.modes.size() == 2U || (channels == 1 && objected)) << channels << ", seed " << seed;
      for (const ModeEstimate& mode : found.modes)
        EXPECT_LT(std::abs(mode.pole.damping_ratio() - ratio), 4.0 * mode.pole.damping_ratio_deviation);
    }
}

TEST(OneMode, IsNotSplit) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Record record = pair(0.0, 1, 0.02, seed);
    EXPECT_EQ(find_modes("one", record, false, {}).modes.size(), 1U) << seed;
  }
}

TEST(OneMode, ThatFollowsItsAmplitudeIsNotSplit) {
  for (const double power : {0.0, 1.0, 2.0, 3.0})
    for (const double b : {0.0, 2e-4, 1e-3}) {
      Record record = pair(0.0, 1, 0.0, 1);
      record.samples = test::nonlinear_decay(5.0, 0.003, power, b, interval, count).transpose();
      record.samples += 0.01 * standard_normal(count, 1, 9).transpose();
      const RecordModes found = find_modes("one", record, false, {});
      int near = 0;
      for (const ModeEstimate& mode : found.modes) near += std::abs(mode.pole.frequency_hz() - 5.0) < 0.5;
      EXPECT_EQ(near, 1) << "power " << power << ", b " << b;
    }
}

// What `identify`, `track` and `backbone` ask of the mode that they follow.

std::optional<ClosePair> in_place_of_the_mode(const Record& record) {
  const VectorXd signal = record.samples.row(0).transpose();
  ModalAnalysisSettings near;
  near.expected_frequency_hz = 5.0;
  const auto decay = fitted_decay(signal, interval, dominant_mode(signal, interval, near));
  return decay ? close_pair(*decay) : std::nullopt;
}

// Modes that are farther apart are companions of each other to the modal analysis itself.
TEST(ModeOfOneSignal, IsTwoWhereTwoModesWere) {
  for (const double apart : {0.005, 0.01})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const auto found = in_place_of_the_mode(pair(apart, 1, 0.01, seed));
      ASSERT_TRUE(found && found->wins) << apart << ", seed " << seed;
      EXPECT_STREQ(found->objection(), "close_modes");
      for (const Pole& pole : {found->low(), found->high()})
        EXPECT_LT(std::abs(pole.damping_ratio() - ratio), 4.0 * pole.damping_ratio_deviation);
    }
}

TEST(ModeOfOneSignal, IsOneWhereOneWas) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const auto found = in_place_of_the_mode(pair(0.0, 1, 0.02, seed));
    EXPECT_FALSE(found) << "seed " << seed;
  }
}

TEST(ModeOfOneSignal, IsNotTwoWhereItFollowsItsAmplitude) {
  for (const double power : {0.0, 1.0, 2.0, 3.0})
    for (const double b : {2e-4, 1e-3}) {
      Record record = pair(0.0, 1, 0.0, 1);
      record.samples = test::nonlinear_decay(5.0, 0.003, power, b, interval, count).transpose();
      record.samples += 0.01 * standard_normal(count, 1, 9).transpose();
      const auto found = in_place_of_the_mode(record);
      EXPECT_FALSE(found && found->wins) << "power " << power << ", b " << b;
    }
}

}  // namespace
}  // namespace beamid::experiments::close_pair_test
