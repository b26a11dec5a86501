// Oracles: the filter against the closed form, and the first terms of the closed form's series.
#include "experiments/studies/atlas/atlas.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(Atlas, RefusesAStepThatDoesNotShowTheMotion) {
  AtlasSettings settings;
  settings.beam = unit(0.01);
  settings.interval = 3.5;
  EXPECT_THROW(make_atlas(settings, [](const std::string&) {}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::atlas_test
