// Pulses of a hammer on few samples: what their momentum is worth.
#include "experiments/modal/hit_sampling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/modal/study/hammer_study.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/studies/modal/report.hpp"
#include "tests/experiments/modal/struck_modes.hpp"

namespace beamid::experiments::hit_sampling_test {
namespace {

constexpr double pi = std::numbers::pi;
const test::StruckMode truth{25, 0.008, 11.43};

double half_sine(double t, double duration) {
  return t > 0 && t < duration ? 100 * std::sin(pi * t / duration) : 0;
}

/// A half sine of so many samples that begins at `at`, as it is or as a filter leaves it that is flat to 0.4
/// and falls as a cosine to nothing at half of the sampling rate.
Eigen::VectorXd pulse(double samples, double at, bool filtered, double noise, std::uint64_t seed) {
  constexpr Eigen::Index count = 400;
  constexpr int fine = 64;
  Eigen::VectorXd force = noise * standard_normal(count, seed, 1);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) - at;
    if (!filtered) {
      force[k] += half_sine(t, samples);
      continue;
    }
    for (int i = 0; i <= samples * fine; ++i) {
      const double x = t - static_cast<double>(i) / fine;
      const double flat = 0.9, edge = 0.1, odd = 2 * edge * x;  // raised cosine around 0.45
      const double sinc = std::abs(x) < 1e-9 ? flat : std::sin(pi * flat * x) / (pi * x);
      const double roll = std::abs(1 - odd * odd) < 1e-6 ? pi / 4 : std::cos(pi * edge * x) / (1 - odd * odd);
      force[k] += half_sine(static_cast<double>(i) / fine, samples) * sinc * roll / fine;
    }
  }
  return force;
}

std::vector<HitSampling> sampling_of(double samples, bool filtered, double noise) {
  std::vector<HitSampling> found;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Eigen::VectorXd force =
        pulse(samples, 200 + 0.37 * static_cast<double>(seed), filtered, noise, seed);
    for (const Hit& hit : find_hits(force, 1e-3)) found.push_back(hit_sampling(force, hit));
  }
  return found;
}

// Oracle: the momentum of the pulse that was sampled, 2 / pi of 100 N times its duration. At all places on
// the grid it lies in the interval of 1.96 deviations; from 4 samples on it is wrong by less than 5 %, from 6
// by 1 %.
TEST(HitSampling, KnowsHowFarTheMomentumIsOff) {
  for (const double samples : {2.0, 2.5, 3.0, 4.0, 5.0, 8.0, 12.0}) {
    double furthest = 0;
    for (int place = 0; place < 20; ++place) {
      const Eigen::VectorXd force = pulse(samples, 200 + 0.05 * place, false, 0, 1);
      furthest = std::max(furthest, std::abs(force.sum() / (200 / pi * samples) - 1));
    }
    const double told = unresolved_at_once(sampling_of(samples, false, 0.1));
    EXPECT_GT(1.96 * told, 0.95 * furthest) << samples;
    EXPECT_LT(told, 4 * furthest) << samples;
    EXPECT_EQ(told > coarse_momentum, samples <= 5) << samples;
    EXPECT_EQ(told > lost_momentum, samples <= 3) << samples;
  }
}

TEST(HitSampling, SaysNothingOfShortPulsesThatAFilterBroadened) {
  for (const double samples : {1.5, 2.0, 3.0, 4.0})
    for (const double noise : {0.1, 0.5}) {
      const std::vector<HitSampling> hits = sampling_of(samples, true, noise);
      EXPECT_TRUE(hits_ring(hits)) << samples;
      EXPECT_EQ(coarse_hits(hits, 1e-3), "") << samples;
    }
}

// Oracle: six hits on one place of the grid err as one does, on different ones by two thirds over sqrt(6).
TEST(HitSampling, DoesNotAverageAliasesOfOnePlace) {
  HitSampling hit;
  hit.aliased = 0.03;
  std::vector<HitSampling> hits(6, hit);
  EXPECT_NEAR(unresolved_on_average(hits), 0.03, 1e-12);
  for (int k = 0; k < 6; ++k) hits[k].place = k / 6.0;
  EXPECT_NEAR(unresolved_on_average(hits), 0.02 / std::sqrt(6), 1e-12);
}

HammerStudy study_of(double samples, std::uint64_t seed) {
  constexpr double interval = 1e-3;
  std::vector<test::Impact> impacts;
  for (int k = 0; k < 4; ++k)
    impacts.push_back({0.5 + 5 * k + 0.37e-3 * k, samples * interval, 80.0 + 10 * k, true});
  ModalStudySettings settings;
  settings.method = {"frf_lscf", {}};
  return study_hits(
      {"hits.csv"},
      {test::with_noise(test::struck_modes({truth}, impacts, interval, 20500), 0.1, 0.05, seed)}, settings);
}

// Oracle: the mass that was simulated.
TEST(HitSampling, GivesNoMassOfHitsOfTwoSamplesAndWidensThatOfThree) {
  const HammerStudy lost = study_of(2, 1);
  ASSERT_EQ(lost.modes.size(), 1u);
  EXPECT_TRUE(std::isnan(lost.modes[0].mass[0]));
  EXPECT_NEAR(lost.modes[0].pole.frequency_hz(), truth.frequency_hz, 1e-3);
  const Results told = report({}, lost);
  EXPECT_EQ(told.values["status"], "contradicted");
  EXPECT_TRUE(told.values["modes"][0]["channels"][0]["modal_mass_kg"].is_null());

  const HammerStudy coarse = study_of(4, 1);
  EXPECT_NE(coarse.responses.coarse.find("anti-alias"), std::string::npos);
  EXPECT_GT(coarse.modes[0].deviation[0], 0.004 * truth.mass);
  EXPECT_LT(std::abs(coarse.modes[0].mass[0] - truth.mass), 1.96 * coarse.modes[0].deviation[0]);
  EXPECT_FALSE(report({}, coarse).values.contains("status"));

  const HammerStudy fine = study_of(10, 1);
  EXPECT_EQ(fine.responses.coarse, "");
  EXPECT_TRUE(fine.responses.objections.empty());
  EXPECT_LT(std::abs(fine.modes[0].mass[0] - truth.mass), 1.96 * fine.modes[0].deviation[0]);
}

}  // namespace
}  // namespace beamid::experiments::hit_sampling_test
