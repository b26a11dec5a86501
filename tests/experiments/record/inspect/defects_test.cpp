// Defects put into signals, and healthy signals of every kind in which none may be found.
#include "experiments/record/inspect/defects.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <random>

namespace beamid::experiments::defects_test {
namespace {

using Signal = std::vector<double>;
constexpr double turn = 2 * std::numbers::pi;

Signal sampled(std::size_t count, const std::function<double(double)>& value) {
  Signal signal(count);
  for (std::size_t k = 0; k < count; ++k) signal[k] = value(static_cast<double>(k));
  return signal;
}

void add_noise(Signal& signal, double deviation, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, deviation);
  for (double& sample : signal) sample += normal(random);
}

/// A decay of 5 units whose period is so many samples, with a twentieth of a mode six times as fast.
Signal decay(std::size_t count, double period, double noise, double ratio = 0.005) {
  Signal signal = sampled(count, [&](double k) {
    const double angle = turn * k / period;
    return 5 * std::exp(-ratio * angle) * std::cos(angle + 0.3) +
           0.25 * std::exp(-ratio * 6.27 * angle) * std::cos(6.27 * angle + 1);
  });
  add_noise(signal, noise, 5);
  return signal;
}

std::size_t beyond(const Signal& signal, double limit) {
  return static_cast<std::size_t>(
      std::count_if(signal.begin(), signal.end(), [&](double value) { return std::abs(value) >= limit; }));
}

// Oracle: the samples that the clamp changed, whatever the sampling.
TEST(Defects, FindEveryClippedSample) {
  for (const double period : {7.3, 10.0, 29.0, 151.0})
    for (const double limit : {4.5, 4.0, 2.5}) {
      const Signal whole = decay(static_cast<std::size_t>(40 * period), period, 0.005);
      if (beyond(whole, limit) < 12) continue;  // too few to be told from chance
      Signal clipped = whole;
      for (double& sample : clipped) sample = std::clamp(sample, -limit, limit);
      const Defects found = find_defects(clipped, SignalKind::motion);
      EXPECT_EQ(samples_in(found.clipped), beyond(whole, limit)) << period << ", " << limit;
      EXPECT_TRUE(found.spikes.empty() && found.dropped.empty() && found.repeated.empty());
    }
}

// A limit behind a coarse converter comes and goes by small steps, but holds for longer than a sine does.
TEST(Defects, FindClippingBehindACoarseConverter) {
  for (const double period : {29.0, 151.0})
    for (const double step : {0.05, 0.1}) {
      Signal clipped = decay(static_cast<std::size_t>(40 * period), period, 0.005);
      for (double& sample : clipped) sample = step * std::round(std::clamp(sample, -2.5, 2.5) / step);
      const Defects found = find_defects(clipped, SignalKind::motion);
      EXPECT_GE(samples_in(found.clipped), beyond(clipped, 2.49)) << period << ", " << step;
    }
}

void expect_healthy(const Signal& signal, const std::string& what) {
  const Defects found = find_defects(signal, SignalKind::motion);
  EXPECT_FALSE(found.dead) << what;
  EXPECT_TRUE(found.spikes.empty()) << what;
  EXPECT_TRUE(found.clipped.empty()) << what;
  EXPECT_TRUE(found.dropped.empty()) << what;
  EXPECT_TRUE(found.repeated.empty()) << what;
  EXPECT_FALSE(found.rattle.has_value()) << what;
}

TEST(Defects, AreNotFoundInHealthySignals) {
  for (const double period : {4.0, 6.7, 10.0, 29.0, 150.0, 1000.0})
    for (const double noise : {0.0, 0.002, 0.05})
      for (const std::size_t count : {40u, 400u, 5000u}) {
        const Signal signal = decay(count, period, noise);
        const std::string what = std::to_string(period) + " samples a period, noise " +
                                 std::to_string(noise) + ", " + std::to_string(count);
        expect_healthy(signal, what);
        for (const int bits : {4, 6, 8, 12, 16}) {
          Signal coarse = signal;
          const double step = 10.5 / std::ldexp(1, bits);
          for (double& sample : coarse) sample = step * std::round(sample / step);
          expect_healthy(coarse, what + ", " + std::to_string(bits) + " bits");
        }
        Signal printed = signal;
        for (double& sample : printed) {
          char text[40];
          std::snprintf(text, sizeof(text), "%.4g", sample);
          sample = std::atof(text);
        }
        expect_healthy(printed, what + ", four digits");
      }
}

TEST(Defects, AreNotFoundInSteadySinesHitsAndReleases) {
  for (const double period : {4.0, 5.0, 8.0, 20.0, 21.7})
    expect_healthy(sampled(2000, [&](double k) { return std::sin(turn * k / period); }), "steady sine");
  Signal random(4000, 0.0);
  add_noise(random, 1, 9);
  expect_healthy(random, "noise");
  for (double& sample : random) sample = std::round(sample * 5) / 5;
  expect_healthy(random, "coarse noise");
  // a sensor at rest that reads zeros, hit, decayed into its own steps, hit again
  Signal hits = sampled(4000, [](double k) {
    const auto ring = [&](double at) {
      return k < at ? 0 : std::exp(-0.004 * (k - at)) * std::sin(turn * (k - at) / 23.7);
    };
    return ring(300) + ring(2600);
  });
  for (double& sample : hits) sample = std::round(sample * 500) / 500;
  expect_healthy(hits, "two hits");
  // pulled slowly, held, released
  Signal release = sampled(3000, [](double k) {
    return k < 500 ? k / 500 : k < 900 ? 1 : std::exp(-0.002 * (k - 900)) * std::cos(turn * (k - 900) / 40);
  });
  for (double& sample : release) sample = std::round(sample * 4000) / 4000;
  expect_healthy(release, "release");
}

TEST(Defects, NameAnAbsurdSampleASpike) {
  for (const double value : {1e3, -1e10, 1e300}) {
    Signal signal = decay(4000, 29, 0.01);
    signal[1000] = value;
    const Defects found = find_defects(signal, SignalKind::motion);
    ASSERT_EQ(found.spikes.size(), 1u) << value;
    EXPECT_EQ(found.spikes[0].first, 1000u);
    EXPECT_EQ(found.spikes[0].length, 1u);
    EXPECT_TRUE(found.clipped.empty() && found.dropped.empty());
    EXPECT_FALSE(found.dead || found.rattle);
  }
  Signal dead(600, 0.0);
  dead[70] = 1;
  EXPECT_TRUE(find_defects(dead, SignalKind::motion).dead);
  EXPECT_TRUE(find_defects(Signal(600, 3.0), SignalKind::motion).dead);
  EXPECT_FALSE(find_defects(Signal(600, 0.0), SignalKind::force).dead);
}

// Oracle: the samples that were held, of those on a flank, where a repetition can be told from a crest.
TEST(Defects, CountRepeatedReadings) {
  for (const double period : {12.0, 29.0, 150.0}) {
    Signal signal = decay(5000, period, 0.05);
    for (double& sample : signal) sample = std::round(sample / 0.002) * 0.002;
    std::mt19937 random(3);
    std::size_t held = 0;
    for (std::size_t k = 1; k < signal.size(); ++k)
      if (random() % 25 == 0) signal[k] = signal[k - 1], ++held;
    const Defects found = find_defects(signal, SignalKind::motion);
    EXPECT_GT(samples_in(found.repeated), held / 4) << period;
    for (const auto& run : found.repeated) EXPECT_EQ(signal[run.first], signal[run.first - 1]);
  }
}

TEST(Defects, FindDropOutsAtZeroAndHeld) {
  Signal signal = decay(4000, 29, 0.01);
  std::fill(signal.begin() + 500, signal.begin() + 540, 0.0);
  std::fill(signal.begin() + 2000, signal.begin() + 2100, signal[1999]);
  const Defects found = find_defects(signal, SignalKind::motion);
  ASSERT_EQ(found.dropped.size(), 2u);
  EXPECT_EQ(found.dropped[0].first, 500u);
  EXPECT_EQ(found.dropped[0].length, 40u);
  EXPECT_EQ(found.dropped[1].first, 1999u);
  EXPECT_EQ(found.dropped[1].length, 101u);
}

// A contact that hammers, at every crest, while the envelope is above 2.
TEST(Defects, HearARattle) {
  const Signal quiet = decay(6000, 40, 0.01);
  std::mt19937 random(4);
  std::normal_distribution<double> normal(0, 0.2);
  Signal signal = quiet;
  std::size_t end = 0;
  for (std::size_t k = 0; k < signal.size(); ++k)
    if (std::abs(quiet[k]) > 2) signal[k] += normal(random), end = k;
  const Defects found = find_defects(signal, SignalKind::motion);
  ASSERT_TRUE(found.rattle.has_value());
  EXPECT_NEAR(static_cast<double>(found.rattle->last), static_cast<double>(end), 500);
  EXPECT_GT(found.rattle->ratio, 5);
}

// A sensor that did not answer now and then; a signal through zero is none.
TEST(Defects, ZerosWithinTheMotionAreDropouts) {
  std::vector<double> signal(2000);
  for (std::size_t k = 0; k < signal.size(); ++k)
    signal[k] = std::exp(-5e-4 * static_cast<double>(k)) * std::sin(0.1 * static_cast<double>(k)) +
                1e-3 * std::sin(37.0 * static_cast<double>(k * k));
  EXPECT_TRUE(find_defects(signal, SignalKind::motion).dropped.empty());
  std::size_t zeros = 0;
  for (std::size_t k = 16; k < 1000; k += 63, ++zeros) signal[k] = 0.0;  // at the peaks
  const Defects found = find_defects(signal, SignalKind::motion);
  EXPECT_EQ(found.dropped.size(), zeros);
  for (const auto& run : found.dropped) EXPECT_EQ(run.value, 0.0);
}

// Half sines of 66 samples cut at 60 of them: held by no hand. Hits of a hand below the limit reach no value
// twice. Oracle: how the pulses were made.
TEST(Clipping, OfAForceIsItsFlatTopsInSeveralHits) {
  for (const double limit : {0.1, 2.0}) {
    Signal force(4000, 0.0);
    for (int hit = 0; hit < 3; ++hit)
      for (int k = 0; k < 66; ++k)
        force[static_cast<std::size_t>(500 + 1200 * hit + k)] =
            std::min(limit, (1 + 0.13 * hit) * std::sin(3.14159265358979 * (k + 0.5) / 66));
    EXPECT_EQ(find_defects(force, SignalKind::force).clipped.empty(), limit > 1.5) << limit;
  }
}

}  // namespace
}  // namespace beamid::experiments::defects_test
