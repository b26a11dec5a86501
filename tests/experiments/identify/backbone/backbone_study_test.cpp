// The force law of a decay. Oracle: the hyperbolic spring F = K x / (1 + |x| / x_r), its decays integrated by
// simulated_decay.hpp.
#include "experiments/identify/backbone/backbone_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "experiments/models/estimates.hpp"
#include "tests/experiments/identify/backbone/simulated_decay.hpp"

namespace beamid::experiments::backbone_study_test {
namespace {

using namespace simulated_decay;
using Eigen::Index;

BackboneSettings with_mass() {
  BackboneSettings settings;
  settings.windows.mass = mass;
  settings.mass_known = true;
  return settings;
}

const std::vector<double> places{0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 2.5, 3.0};  // of x_r

double backbone_error(const BackboneStudy& study, double over_bend) {
  const double x = over_bend * bend;
  return study.backbone.force(x) / hyperbolic(x) - 1;
}

int seeds() {
  const char* const wanted = std::getenv("BEAMID_BACKBONE_SEEDS");
  return wanted ? std::atoi(wanted) : 0;
}

// Oracle: the exact period of the hyperbola, by quadrature: M omega^2 over F / A is +2.6, +7.1 and +14.9 % at
// these amplitudes; the release is from 4 x_r, so that windows lie on either side of 3 x_r.
TEST(BackboneStudy, SecantsTakenForTheCurveErrAsTheExactPeriodSays) {
  Decay truth;
  truth.start = 4 * bend, truth.noise = 0.001;
  const BackboneStudy study = study_backbone(decay_record(truth, 1), with_mass());
  const auto over = [&](double place) {
    return 100 * (study.secants.force(place * bend) / hyperbolic(place * bend) - 1);
  };
  EXPECT_NEAR(over(0.2), 2.6, 0.5);
  EXPECT_NEAR(over(0.7), 7.1, 0.5);
  EXPECT_NEAR(over(3.0), 14.9, 0.5);
}

ForceLaw of_windows(const Record& record) {
  WindowSettings settings = with_mass().windows;
  settings.amplitude_ratio = 0.9;
  const AmplitudeWindows windows = amplitude_windows(record, settings);
  return invert_windows(windows.windows, 1.03 * windows.first_amplitude, WindowReading::elastic);
}

// Damping so small that the amplitude hardly falls within a cycle: what is left is the inversion's own error.
TEST(BackboneStudy, InvertsTheWindowsOfASlowDecayWithinOnePerCent) {
  Decay truth;
  truth.start = 4 * bend, truth.noise = 0.001, truth.damping_ratio = 0.002, truth.seconds = 60;
  for (const Quantity quantity : {Quantity::displacement, Quantity::velocity, Quantity::acceleration}) {
    truth.quantity = quantity;
    const ForceLaw law = of_windows(decay_record(truth, 3));
    for (const double place : {0.2, 0.5, 1.0, 2.0, 3.0})
      EXPECT_NEAR(law.force(place * bend) / hyperbolic(place * bend), 1, 0.01)
          << to_string(quantity) << " " << place;
  }
}

// A record that ends at a large amplitude does not show the spring at rest: its secants are held against that
// of the smallest amplitude. Against rest, a decay between 9.9 and 4.8 mm of a cubic spring was 120.3 %
// "known within 0.14 %", and in truth 130 %.
TEST(BackboneStudy, RestIsNamedWhereTheRecordShowsIt) {
  for (const double seconds : {6.0, 20.0}) {
    Decay truth;
    truth.start = 3 * bend, truth.damping_ratio = 0.01, truth.seconds = seconds;
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      const BackboneStudy study = study_backbone(decay_record(truth, seed), with_mass());
      ASSERT_TRUE(study.law()) << seconds;
      EXPECT_EQ(study.first_place(), seconds > 10.0 ? "rest" : "the smallest amplitude");
      const double x = study.largest(), from = study.first_amplitude(),
                   expected = (1.0 + from / bend) / (1.0 + x / bend);
      EXPECT_NEAR(std::log(study.backbone.secant(x) / study.first_stiffness() / expected), 0.0,
                  4.0 * study.ratio_deviation(x))
          << seconds << " s, seed " << seed;
    }
  }
}

TEST(BackboneStudy, FindsTheHyperbolicSpringWithinOnePerCent) {
  const BackboneStudy study = study_backbone(decay_record({}, 1), with_mass());
  for (const double place : places) EXPECT_NEAR(backbone_error(study, place), 0, 0.01) << place;
  EXPECT_TRUE(study.by_record);
  EXPECT_EQ(study.spring, SpringKind::softening);
  EXPECT_EQ(study.loop, LoopKind::elastic);
  EXPECT_EQ(study.record.fits[static_cast<std::size_t>(study.record.best)].name, "elastic");
}

// 300 seeds where BEAMID_BACKBONE_SEEDS=300 asks for them; the few of every build only see a band that is far
// too narrow, since the eleven places of one seed miss together.
void expect_band(Quantity quantity) {
  const int count = std::max(4, seeds());
  int held = 0, all = 0, beyond = 0, over = 0;
  double worst = 0;
  std::vector<int> at(places.size(), 0);
  const char* const first = std::getenv("BEAMID_BACKBONE_FIRST_SEED");
  for (int seed = first ? std::atoi(first) : 1, last = seed + count - 1; seed <= last; ++seed) {
    Decay truth;
    truth.quantity = quantity;
    const BackboneStudy study =
        study_backbone(decay_record(truth, static_cast<std::uint64_t>(seed)), with_mass());
    EXPECT_TRUE(study.by_record) << seed;
    EXPECT_EQ(study.loop, LoopKind::elastic) << seed;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double x = places[i] * bend;
      if (x > 1.02 * study.largest()) {  // not reported: what a low-pass leaves of a release
        ++beyond;
        continue;
      }
      const bool in = std::abs(study.backbone.secant(x) - hyperbolic(x) / x) <
                      quantile_95 * study.backbone.secant_deviation(x);
      held += in, at[i] += in, ++all;
      const double error = backbone_error(study, places[i]);
      worst = std::max(worst, std::abs(error));
      over += std::abs(error) > 0.01;
      if (std::abs(error) > 0.01)
        std::printf("seed %d: %+.4f +- %.4f at %.2f x_r; %s of %d terms to %.3f x_r, lack %.2f\n", seed,
                    error, quantile_95 * study.backbone.secant_deviation(x) / study.backbone.secant(x),
                    places[i], study.by_record ? study.law()->name.c_str() : "windows",
                    static_cast<int>(study.backbone.curve.terms()), study.largest() / bend,
                    study.record.lack);
    }
  }
  const double share = static_cast<double>(held) / all;
  std::printf("%s: band holds %.4f of %d, worst error %.4f; %d beyond what is reported\n",
              to_string(quantity), share, all, worst, beyond);
  for (std::size_t i = 0; i < places.size(); ++i)
    std::printf("  %.2f x_r: %.3f\n", places[i], double(at[i]) / count);
  EXPECT_GE(share, seeds() > 0 ? 0.93 : 0.8);
  EXPECT_LE(share, seeds() > 0 ? 0.97 : 1);
  // Half the band is 0.64 % at 3 x_r: of 300 displacements 0.7 lie beyond 1 % there by chance.
  EXPECT_LE(over, seeds() > 0 ? 3 : 0);
  EXPECT_LE(beyond, 0.05 * count);
}

TEST(BackboneBand, HoldsTheSpringSeenByItsDisplacement) {
  expect_band(Quantity::displacement);
}

TEST(BackboneBand, HoldsTheSpringSeenByItsAcceleration) {
  expect_band(Quantity::acceleration);
}

// Oracle: the closed form of the hyperbola's Masing damping, D = 4/pi (1 + 1/r)(1 - ln(1 + r)/r) - 2/pi.
TEST(BackboneStudy, KnowsMasingsLoop) {
  for (const double start : {0.3, 1.0}) {
    Decay truth;
    truth.masing = true, truth.damping_ratio = 0.005, truth.start = start * bend, truth.seconds = 10;
    const BackboneStudy study = study_backbone(decay_record(truth, 1), with_mass());
    const RecordFit* const between = study.record.find("between");
    ASSERT_TRUE(between && study.law());
    EXPECT_EQ(study.loop, LoopKind::masing) << between->masing << " +- " << between->masing_deviation;
    EXPECT_NEAR(between->masing, 1, 3 * between->masing_deviation);
    const double c = 2 * truth.damping_ratio * std::sqrt(stiffness * mass);
    for (const double place : {0.03, 0.1, 0.25, 0.5, 0.7}) {
      const double r = place * start, x = r * bend, secant = stiffness / (1 + r),
                   omega = std::sqrt(secant / mass),
                   masing = 4 / M_PI * (1 + 1 / r) * (1 - std::log1p(r) / r) - 2 / M_PI,
                   damping = masing + c * omega / (2 * secant);
      EXPECT_NEAR(study.backbone.secant(x) / study.first_stiffness() * (1 + r), 1, 0.03) << r;
      EXPECT_NEAR(study.energy(x, omega) / (2 * M_PI * x * study.backbone.force(x)) / damping, 1, 0.1) << r;
    }
  }
}

TEST(BackboneStudy, SaysLinearOfALinearSpring) {
  Decay truth;
  truth.backbone = [](double x) { return stiffness * x; };
  const BackboneStudy study = study_backbone(decay_record(truth, 4), with_mass());
  EXPECT_EQ(study.spring, SpringKind::linear);
  EXPECT_THAT(backbone_verdict(study), testing::StartsWith("Linear"));
  EXPECT_LT(study.linear_bic(), 10);
  EXPECT_NEAR(study.windows.windows.front().stiffness, stiffness, 0.005 * stiffness);
}

TEST(BackboneStudy, TellsHardeningByDuffing) {
  Decay truth;
  truth.backbone = [](double x) { return stiffness * x + 3e5 * x * x * x; };
  const BackboneStudy study = study_backbone(decay_record(truth, 5), with_mass());
  EXPECT_EQ(study.spring, SpringKind::hardening);
  EXPECT_EQ(study.record.fits[static_cast<std::size_t>(study.record.best)].name, "duffing");
}

TEST(BackboneStudy, SaysNotDeterminedWhereTheAmplitudeHardlyChanges) {
  Decay truth;
  truth.damping_ratio = 0.0005;
  truth.seconds = 3;
  EXPECT_THAT(backbone_verdict(study_backbone(decay_record(truth, 6), with_mass())),
              testing::StartsWith("Force law not determined"));
}

TEST(BackboneStudy, WarnsOfASecondModeNearby) {
  Decay truth;
  truth.second_mode = 0.6;
  const BackboneStudy study = study_backbone(decay_record(truth, 7), with_mass());
  EXPECT_TRUE(!study.objections.empty() || study.spring == SpringKind::not_determined)
      << backbone_verdict(study);
}

TEST(BackboneStudy, RefusesARecordOfNoCycles) {
  Decay truth;
  truth.seconds = 0.5;
  EXPECT_THROW(study_backbone(decay_record(truth, 8), with_mass()), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::backbone_study_test
