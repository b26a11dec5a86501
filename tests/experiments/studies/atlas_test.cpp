// Oracles: the filter against the closed form, and the first terms of the closed form's series.
#include "experiments/studies/atlas/atlas.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/studies/paper/numerical_validation.hpp"

namespace beamid::experiments::atlas_test {
namespace {

Oscillator unit(double damping_ratio) {
  return Oscillator::from_frequency(1.0, 1.0, damping_ratio);
}

class Scheme : public testing::TestWithParam<std::string> {};

// Four digits, or 1e-6 of the parameter where the bias itself is smaller than 1 %.
TEST_P(Scheme, BiasesAFilterAsTheClosedFormSays) {
  for (const double ratio : {0.0015, 0.02, 0.1})
    for (const double step : {0.01, 0.1, 0.5}) {
      const auto predicted = predicted_bias(GetParam(), unit(ratio), step);
      const auto measured = measured_bias(GetParam(), unit(ratio), step);
      ASSERT_TRUE(predicted && measured) << ratio << ", " << step;
      const auto tolerance = [](double value) { return 1e-4 * std::abs(value) + 1e-6; };
      EXPECT_NEAR(measured->stiffness_percent, predicted->stiffness_percent,
                  tolerance(predicted->stiffness_percent))
          << ratio << ", " << step;
      EXPECT_NEAR(measured->damping_percent, predicted->damping_percent,
                  tolerance(predicted->damping_percent))
          << ratio << ", " << step;
    }
}

INSTANTIATE_TEST_SUITE_P(All, Scheme, testing::ValuesIn(paper::compared_schemes()),
                         [](const auto& tested) { return tested.param; });

TEST(HarmlessStep, IsThatOfTheSeries) {
  // C_f / C - 1 = w dt / (2 xi) for forward Euler, (w dt)^2 / 4 for the implicit midpoint rule.
  EXPECT_NEAR(harmless_step("forward_euler", 0.005, 1.0), 2.0 * 0.005 * 0.01, 1e-6);
  EXPECT_NEAR(harmless_step("implicit_midpoint", 0.005, 0.1), std::sqrt(4.0 * 0.001), 1e-4);
  EXPECT_TRUE(std::isinf(harmless_step("exponential", 0.005, 0.1)));
}

class HoldAt : public testing::TestWithParam<double> {};

// Four digits of what a filter finds, or 1e-10 of the parameter.
TEST_P(HoldAt, BiasesAFilterAsTheClosedFormSays) {
  for (const double ratio : {0.002, 0.02, 0.1})
    for (const InputPath path : {InputPath::held, InputPath::linear}) {
      const double dt = 2.0 * M_PI / GetParam();
      const Bias predicted = predicted_hold_bias(path, unit(ratio), dt);
      const auto measured = measured_hold_bias(path, unit(ratio), dt);
      ASSERT_TRUE(measured) << ratio;
      const auto tolerance = [](double value) { return 1e-4 * std::abs(value) + 1e-8; };
      EXPECT_NEAR(measured->stiffness_percent, predicted.stiffness_percent,
                  tolerance(predicted.stiffness_percent))
          << ratio << ", " << to_string(path);
      EXPECT_NEAR(measured->damping_percent, predicted.damping_percent, tolerance(predicted.damping_percent))
          << ratio << ", " << to_string(path);
    }
}

TEST_P(HoldAt, VanishesForABandLimitedForce) {
  // Oracle: none; of the path of 32 samples 7e-6 is left at 10 samples a period, 2e-3 at 3, in the middle.
  const auto measured = measured_hold_bias(InputPath::band_limited, unit(0.02), 2.0 * M_PI / GetParam());
  ASSERT_TRUE(measured);
  EXPECT_LT(std::abs(measured->stiffness_percent), 2e-3);
  EXPECT_LT(std::abs(measured->damping_percent), 5e-3);
}

TEST_P(HoldAt, IsThatOfItsFirstTerms) {
  // Oracle: docs/theory/discretisation_bias.md, one line at the resonance.
  const double p = M_PI / GetParam(), ratio = 0.01, dt = 2.0 * p, sinc = std::sin(p) / p;
  const Bias held = predicted_hold_bias(InputPath::held, unit(ratio), dt),
             straight = predicted_hold_bias(InputPath::linear, unit(ratio), dt);
  const double images = 200.0 / (GetParam() * GetParam());  // [%] of C, of w^2 / w_n^2 in K
  EXPECT_NEAR(held.stiffness_percent, 200.0 * ratio * sinc * std::sin(p), 2.0 * ratio * images);
  EXPECT_NEAR(held.damping_percent, 100.0 * (sinc * std::cos(p) - 1.0), 0.1 * images);
  EXPECT_NEAR(straight.stiffness_percent, 0.0, 2.0 * ratio * images);
  EXPECT_NEAR(straight.damping_percent, 100.0 * (sinc * sinc - 1.0), 0.1 * images);
}

INSTANTIATE_TEST_SUITE_P(SamplesPerPeriod, HoldAt, testing::Values(10.0, 14.0, 29.0, 116.0));

TEST(HoldOfAnInput, RefusesAStepThatDoesNotShowTheMotion) {
  EXPECT_THROW(predicted_hold_bias(InputPath::held, unit(0.01), 3.2), std::invalid_argument);
  EXPECT_THROW(predicted_hold_bias(InputPath::held, unit(0.0), 0.1), std::invalid_argument);
}

TEST(Atlas, RefusesAStepThatDoesNotShowTheMotion) {
  AtlasSettings settings;
  settings.beam = unit(0.01);
  settings.interval = 3.5;
  EXPECT_THROW(make_atlas(settings, [](const std::string&) {}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::atlas_test
