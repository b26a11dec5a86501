// Simulated ringing of one mode whose stiffness steps. Oracle: what it was simulated with.
#include "experiments/identify/tracking/tracking.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "experiments/signal/toolbox.hpp"
#include "experiments/studies/track/report.hpp"
#include "filters/filter_run.hpp"

namespace beamid::experiments::tracking_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double interval = 0.005, noise = 0.01, damping_ratio = 0.002;

/// Exact motion that is continuous where the frequency [Hz] steps, plus white noise.
VectorXd ringing(const std::vector<double>& frequencies, Index samples_each, std::uint64_t seed) {
  const auto total = samples_each * std::ssize(frequencies);
  VectorXd signal = noise * standard_normal(total, seed, 0);
  double y = 1.0, v = 0.0;
  for (Index k = 0; k < total; ++k) {
    signal[k] += y;
    const double w = 2 * std::numbers::pi * frequencies[static_cast<std::size_t>(k / samples_each)];
    const double wd = w * std::sqrt(1 - damping_ratio * damping_ratio), decay = damping_ratio * w;
    const double c = std::cos(wd * interval), s = std::sin(wd * interval) / wd,
                 e = std::exp(-decay * interval);
    const double next = e * (c * y + s * (v + decay * y));
    v = e * (c * v - s * (w * w * y + decay * v));
    y = next;
  }
  return signal;
}

TEST(Tracking, FindsAStepOfStiffnessInTimeAndSize) {
  const double before = 20, after = 22;
  const Index each = 300;
  const Tracking found = track(ringing({before, after}, each, 5), 0, interval, {});
  ASSERT_EQ(found.plateaus.size(), 2u);
  const double step = interval * each, cycle = 1 / after;
  EXPECT_NEAR(found.plateaus[0].to, step, 1.5 * cycle);
  EXPECT_LT(found.plateaus[1].from - step, 8 * cycle);
  const double expected[] = {before, after};
  for (int i : {0, 1}) {
    const Plateau& plateau = found.plateaus[static_cast<std::size_t>(i)];
    EXPECT_NEAR(plateau.frequency_hz, expected[i], 4 * plateau.frequency_deviation_hz);
    EXPECT_LT(plateau.frequency_deviation_hz, 1e-3 * expected[i]);
    EXPECT_NEAR(plateau.damping_ratio, damping_ratio, 4 * plateau.damping_ratio_deviation);
    EXPECT_NEAR(plateau.noise, noise, 4 * noise * plateau.noise_relative_deviation);
    EXPECT_LT(plateau.noise_relative_deviation, 0.15);
  }
  const auto between = changes(found);
  ASSERT_EQ(between.size(), 1u);
  EXPECT_TRUE(between[0].of_stiffness());
  EXPECT_NEAR(between[0].stiffness, 0.21, 4 * between[0].stiffness_deviation);
  EXPECT_EQ(found.beat, "");
}

TEST(Tracking, HasTheLikelihoodsOfItsFilterSideBySide) {
  // Oracle: runs of the filter of seven states, one by one. Five noises: more than there are lanes.
  const Index count = 600;
  Ringing ringing_mode;
  ringing_mode.time = VectorXd::LinSpaced(count, 0.0, interval * static_cast<double>(count - 1));
  ringing_mode.signal = ringing({20}, count, 3);
  ringing_mode.interval = interval, ringing_mode.band_hz = {10, 40}, ringing_mode.centre_hz = 20;
  ringing_mode.noise = noise;
  const filters::Measurements span = ringing_mode.span(0, count - 1);
  const filters::Gaussian initial = fresh_estimate(ringing_mode, 0);
  std::vector<filters::Noise> noises;
  for (const double share : {0.5, 0.9, 1.0, 1.1, 2.0})
    noises.push_back(ringing_noise(ringing_mode, share * noise, share * typical_force(ringing_mode), 0.02));
  const std::vector<double> found = ringing_likelihoods(ringing_mode, span, initial)(noises);
  ASSERT_EQ(found.size(), noises.size());
  for (std::size_t i = 0; i < noises.size(); ++i) {
    const auto filter = ringing_filter(ringing_mode, noises[i]);
    const filters::FilterRun run = filters::run(*filter, initial, span);
    EXPECT_NEAR(found[i], run.log_likelihood, 1e-8 * std::abs(run.log_likelihood)) << i;
  }
}

TEST(Tracking, NamesTheBeatOfTwoConstantModes) {
  const Index count = 4000;
  for (const double apart : {0.02, 0.05, 0.1})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      VectorXd signal = noise * standard_normal(count, seed, 0);
      for (const double hz : {5.0, 5.0 * (1 + apart)}) {
        const double w = 2 * std::numbers::pi * hz;
        for (Index k = 0; k < count; ++k) {
          const double t = interval * static_cast<double>(k);
          signal[k] += std::exp(-damping_ratio * w * t) * std::cos(w * t + static_cast<double>(seed));
        }
      }
      const Tracking found = track(signal, 0, interval, {});
      const bool fitted = found.plateaus.size() == 1 && !found.plateaus[0].companions_hz.empty();
      EXPECT_TRUE(fitted || found.beat.find("Modes of constant frequency, the strongest at") == 0)
          << apart << " " << seed;
    }
}

// Oracle: the binomial distribution at the probability that was asked for; 1e-3 of test runs fail.
TEST(Tracking, FindsNoMoreChangesWhereThereAreNoneThanStated) {
  const double asked = 0.05;
  const int runs = 40;
  int alarmed = 0;
  for (int seed = 1; seed <= runs; ++seed) {
    Ringing record{
        VectorXd::LinSpaced(800, 0, 799 * interval), ringing({20}, 800, seed), interval, {10, 40}, 20, 0};
    record.noise = typical_noise(record);
    EXPECT_NEAR(record.noise, noise, 0.15 * noise);
    alarmed += find_segments(record, 0.02, asked).begins.size() > 1;
  }
  EXPECT_LE(alarmed,
            boost::math::quantile(boost::math::complement(boost::math::binomial(runs, asked), 1e-3)));
}

// A known span, the walk as told. Oracle: the normal distribution, 1e-4 of test runs fail either way.
TEST(Tracking, MeansOfPlateausCoverTheTruth) {
  const int runs = 24;
  TrackSettings settings;
  settings.walk = 0.0;
  settings.band_hz = {10.0, 40.0};
  double squares = 0;
  for (int seed = 1; seed <= runs; ++seed) {
    const Tracking found = track(ringing({20}, 160, 100 + seed), 0, interval, settings);
    ASSERT_EQ(found.plateaus.size(), 1u);
    const Plateau& plateau = found.plateaus[0];
    squares += std::pow((plateau.frequency_hz - 20) / plateau.frequency_deviation_hz, 2);
    // Without a walk the whole history is one value, also where its integral depends on it entirely.
    for (const VectorXd& history : {found.frequency_hz, found.damping_ratio})
      EXPECT_LT(history.maxCoeff() - history.minCoeff(), 1e-8 * plateau.frequency_hz);
  }
  EXPECT_GT(squares, 6.1);   // chi-square of 24 degrees, 1e-4
  EXPECT_LT(squares, 61.1);  // and 1 - 5e-5
}

TEST(Tracking, BandGrowsWhereTheMotionIsLostInNoise) {
  VectorXd signal = ringing({20}, 400, 7);
  signal.tail(200) = noise * standard_normal(200, 8, 0);
  TrackSettings settings;
  settings.walk = 0.02;
  settings.band_hz = {10.0, 40.0};
  const Tracking found = track(signal, 0, interval, settings);
  EXPECT_GT(found.frequency_deviation.tail(50).mean(), 5 * found.frequency_deviation.segment(60, 80).mean());
}

// A slow sway of four fifths of the amplitude, 0.9 Hz beneath 20 Hz: left in, it split the decay into
// plateaus, or made intervals eight times as wide. Oracle: the frequency simulated; the same record without
// the sway.
TEST(Tracking, TakesOutASwayBelowTheBand) {
  const VectorXd plain = ringing({20}, 600, 11),
                 time =
                     interval * VectorXd::LinSpaced(plain.size(), 0, static_cast<double>(plain.size() - 1)),
                 sway = 0.8 * (2 * std::numbers::pi * 0.9 * time.array()).sin();
  TrackSettings settings;
  settings.walk = 0;
  settings.band_hz = {10.0, 40.0};
  const Tracking without = track(plain, 0, interval, settings),
                 found = track(plain + sway, 0, interval, settings);
  EXPECT_EQ(without.sway, 0);
  EXPECT_NEAR(found.sway, 0.8 / std::sqrt(2.0), 0.1);
  ASSERT_EQ(found.plateaus.size(), 1u);
  const Plateau& plateau = found.plateaus[0];
  EXPECT_NEAR(plateau.frequency_hz, 20, 4 * plateau.frequency_deviation_hz);
  EXPECT_LT(plateau.frequency_deviation_hz, 1.5 * without.plateaus[0].frequency_deviation_hz);
}

TEST(Tracking, RefusesSettingsThatMakeNoSense) {
  const VectorXd signal = ringing({20}, 400, 1);
  EXPECT_THROW(track(signal, 0, interval, {{{40, 10}}}), std::invalid_argument);
  EXPECT_THROW(track(signal, 0, interval, {{{10, 400}}}), std::invalid_argument);
  EXPECT_THROW(track(signal, 0, interval, {{}, -1.0}), std::invalid_argument);
  EXPECT_THROW(track(signal, 0, interval, {{}, {}, 0.0}), std::invalid_argument);
  EXPECT_THROW(track(signal.head(30), 0, interval, {{{10, 40}}}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::tracking_test
