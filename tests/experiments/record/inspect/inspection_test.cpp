// Faults put into records, and whether the inspection finds them where they are.
#include "experiments/record/inspect/inspection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "experiments/record/inspect/defects.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::inspection_test {
namespace {

using Eigen::VectorXd;

constexpr double rate = 1000.0, frequency = 20.0;

/// Noise, a hit of ten units at 0.5 s that rings at 20 Hz, one of six at 2.5 s.
std::vector<double> two_hits(double noise, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, noise);
  std::vector<double> signal(4096);
  for (std::size_t k = 0; k < signal.size(); ++k) {
    const double t = static_cast<double>(k) / rate;
    signal[k] = normal(random);
    for (const auto& [at, size] : {std::pair{0.5, 10.0}, std::pair{2.5, 6.0}})
      if (t >= at)
        signal[k] += size * std::exp(-3.0 * (t - at)) * std::sin(2 * std::numbers::pi * frequency * (t - at));
  }
  return signal;
}

Inspection inspected(const std::vector<double>& time, const std::vector<double>& signal) {
  std::string text = "time_s,acceleration_m_per_s2\n";
  for (std::size_t k = 0; k < signal.size(); ++k) {
    char line[80];
    std::snprintf(line, sizeof(line), std::isnan(signal[k]) ? "%.6f,nothing\n" : "%.6f,%.6f\n", time[k],
                  signal[k]);
    text += line;
  }
  const TemporaryFile file("record.csv", text);
  return inspect(file.path(), {});
}

std::vector<double> even_times(std::size_t count) {
  std::vector<double> time(count);
  for (std::size_t k = 0; k < count; ++k) time[k] = static_cast<double>(k) / rate;
  return time;
}

Inspection inspected(const std::vector<double>& signal) {
  return inspected(even_times(signal.size()), signal);
}

TEST(Inspection, FindsNothingWrongWithAGoodRecord) {
  const Inspection found = inspected(two_hits(0.01));
  EXPECT_TRUE(found.sampling.uniform);
  EXPECT_TRUE(found.skipped_lines.empty());
  const InspectedChannel& channel = found.channels.at(0);
  EXPECT_TRUE(channel.defects.clipped.empty());
  EXPECT_TRUE(channel.defects.dropped.empty());
  EXPECT_FALSE(channel.defects.dead);
  EXPECT_NEAR(channel.frequency_hz, frequency, 0.1);
}

TEST(Inspection, FindsTheHits) {
  const InspectedChannel channel = inspected(two_hits(0.01)).channels.at(0);
  ASSERT_EQ(channel.events.size(), 2u);
  EXPECT_NEAR(static_cast<double>(channel.events[0].sample), 500, 3);
  EXPECT_NEAR(static_cast<double>(channel.events[1].sample), 2500, 3);
  EXPECT_NEAR(channel.events[0].size, 10 * std::exp(-3.0 / 80), 0.1);  // a quarter period later
}

TEST(Inspection, FindsClipping) {
  std::vector<double> signal = two_hits(0.01);
  for (double& sample : signal) sample = std::clamp(sample, -7.0, 7.0);
  const InspectedChannel channel = inspected(signal).channels.at(0);
  ASSERT_FALSE(channel.defects.clipped.empty());
  EXPECT_EQ(channel.defects.clipped[0].value, 7.0);
  EXPECT_NEAR(static_cast<double>(channel.defects.clipped[0].first), 506,
              2);  // asin(0.7) / (2 pi 20 Hz) later
}

TEST(Inspection, FindsDropOuts) {
  std::vector<double> signal = two_hits(0.01);
  std::fill(signal.begin() + 1000, signal.begin() + 1030, 0.0);
  std::fill(signal.begin() + 3000, signal.begin() + 3005, std::nan(""));
  const InspectedChannel channel = inspected(signal).channels.at(0);
  ASSERT_EQ(channel.defects.dropped.size(), 2u);
  EXPECT_EQ(channel.defects.dropped[0].first, 1000u);
  EXPECT_EQ(channel.defects.dropped[0].length, 30u);
  EXPECT_EQ(channel.defects.dropped[1].first, 3000u);
  EXPECT_EQ(channel.missing, 5u);
}

TEST(Inspection, FindsGapsRepeatsAndJitter) {
  const std::vector<double> signal = two_hits(0.01);
  std::vector<double> time = even_times(signal.size());
  for (std::size_t k = 2000; k < time.size(); ++k) time[k] += 0.05;
  time[3000] = time[2999];
  SamplingCheck check = inspected(time, signal).sampling;
  EXPECT_FALSE(check.uniform);
  EXPECT_THAT(check.gaps, testing::Contains(2000u));
  EXPECT_NEAR(check.longest_gap, 0.051, 1e-6);
  EXPECT_THAT(check.repeats, testing::ElementsAre(3000u));

  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 1e-4);
  time = even_times(signal.size());
  for (double& instant : time) instant += normal(random);
  check = inspected(time, signal).sampling;
  EXPECT_FALSE(check.uniform);
  EXPECT_NEAR(check.jitter, std::numbers::sqrt2 * 1e-4, 0.1e-4);  // of the difference of two
}

// Oracle: the noise that was added; steady sine of amplitude one, so that its mean square is one half.
TEST(Inspection, MeasuresNoiseAndSignalToNoiseRatioWithinOneDecibel) {
  for (const double noise : {0.3, 0.03, 0.003}) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0.0, noise);
    std::vector<double> signal(8192);
    for (std::size_t k = 0; k < signal.size(); ++k)
      signal[k] = std::sin(2 * std::numbers::pi * frequency * static_cast<double>(k) / rate) + normal(random);
    const InspectedChannel channel = inspected(signal).channels.at(0);
    EXPECT_NEAR(20 * std::log10(channel.noise / noise), 0, 1);
    EXPECT_NEAR(channel.signal_to_noise_db, 10 * std::log10(0.5 / (noise * noise)), 1);
  }
}

TEST(Inspection, TakesAnUndescribedFileAsItIs) {
  std::string text = "\n";
  for (int k = 0; k < 200; ++k) {
    char line[80];
    std::snprintf(line, sizeof(line), "%.6f\t%.6f\t%.6f\n", 0.001 * k, 30.2 + 1e-4 * ((k * 7919) % 13),
                  std::sin(0.3 * k));
    text += line;
  }
  const TemporaryFile file("plain.txt", text);
  const Inspection found = inspect(file.path(), {});
  EXPECT_TRUE(found.has_time);
  ASSERT_EQ(found.channels.size(), 2u);
  EXPECT_TRUE(found.channels[0].defects.dead);
  EXPECT_FALSE(found.channels[1].defects.dead);
  EXPECT_FALSE(found.channels[1].quantity.has_value());
  EXPECT_NEAR(found.channels[1].frequency_hz, 0.3 * rate / (2 * std::numbers::pi), 0.5);
}

/// Noise of 0.01 and a motion of one unit that a slow hand lets go at 1 s: 12 Hz.
std::vector<double> let_go() {
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0, 0.003);
  std::vector<double> signal(5000);
  for (std::size_t k = 0; k < signal.size(); ++k) {
    const double t = static_cast<double>(k) / rate - 1;
    signal[k] = normal(random) + (t < -0.5   ? 0
                                  : t < -0.2 ? (t + 0.5) / 0.3
                                  : t < 0    ? 1
                                             : std::exp(-t) * std::cos(2 * std::numbers::pi * 12 * t));
  }
  return signal;
}

TEST(Inspection, FindsTheReleaseOfASlowHand) {
  const InspectedChannel channel = inspected(let_go()).channels.at(0);
  ASSERT_EQ(channel.events.size(), 1u);
  EXPECT_NEAR(static_cast<double>(channel.events[0].sample), 1000, 15);
}

TEST(Inspection, FindsDriftAndStartUp) {
  std::vector<double> signal = two_hits(0.01);
  EXPECT_FALSE(inspected(signal).channels.at(0).wandering.has_value());
  for (std::size_t k = 0; k < signal.size(); ++k) signal[k] += 3 * std::sin(0.001 * static_cast<double>(k));
  ASSERT_TRUE(inspected(signal).channels.at(0).wandering.has_value());
  EXPECT_FALSE(inspected(signal).channels.at(0).wandering->start_up);
  signal = two_hits(0.01);
  for (std::size_t k = 0; k < signal.size(); ++k) signal[k] += 6 * std::exp(-0.005 * static_cast<double>(k));
  ASSERT_TRUE(inspected(signal).channels.at(0).wandering.has_value());
  EXPECT_TRUE(inspected(signal).channels.at(0).wandering->start_up);
}

// Oracle: what ../shared/data/README.md and the files themselves say.
TEST(Inspection, FindsWhatIsKnownOfTheMeasuredRecords) {
  const std::filesystem::path folder = BEAMID_SOURCE_DIR "/../shared/data";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no measured records beside the project";
  const Inspection double_hit = inspect(folder / "unb-tip-mass/massa4_test1-4.txt", {});
  ASSERT_EQ(double_hit.channels.size(), 3u);
  EXPECT_TRUE(double_hit.channels[0].defects.dead);
  const std::vector<SignalEvent>& hits = double_hit.channels[2].events;
  ASSERT_EQ(hits.size(), 2u);
  EXPECT_NEAR(double_hit.time[static_cast<std::size_t>(hits[0].sample)], 0.006, 0.002);
  EXPECT_NEAR(double_hit.time[static_cast<std::size_t>(hits[1].sample)], 0.022, 0.002);
  const Inspection impulse = inspect(folder / "chowdhury-impulse/impulse.lvm", {});
  ASSERT_EQ(impulse.channels.at(0).events.size(), 1u);
  EXPECT_NEAR(impulse.time[static_cast<std::size_t>(impulse.channels[0].events[0].sample)], 1.1, 0.02);
  const Inspection moving = inspect(folder / "dropbear-moving-support/slow_10_steps_test0.txt", {});
  EXPECT_THAT(moving.skipped_lines, testing::ElementsAre(8u));
  EXPECT_EQ(moving.channels.at(0).events.size(), 10u);
  for (const InspectedChannel* sound : {&double_hit.channels[1], &double_hit.channels[2],
                                        &impulse.channels[0], &moving.channels[0], &moving.channels[2]}) {
    const Defects& none = sound->defects;
    EXPECT_TRUE(none.clipped.empty() && none.dropped.empty() && none.spikes.empty() && none.repeated.empty());
    EXPECT_FALSE(none.rattle.has_value());
  }
}

}  // namespace
}  // namespace beamid::experiments::inspection_test
