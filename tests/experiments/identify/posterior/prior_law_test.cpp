// Priors as functions of a standard normal number. Oracles: their closed forms, Simpson's rule, differences.
#include "experiments/identify/posterior/posterior_study.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace beamid::experiments::prior_law_test {
namespace {

Unknown stiffness(Form form, double guess, double deviation) {
  Unknown unknown;
  unknown.name = "k";
  unknown.guess = guess;
  unknown.deviation = deviation;
  unknown.form = form;
  return unknown;
}

Unknown bounded(double guess, double deviation, double lower, double upper) {
  Unknown unknown = stiffness(Form::bounded, guess, deviation);
  unknown.lower = lower;
  unknown.upper = upper;
  return unknown;
}

std::vector<PriorLaw> every_law() {
  return {{stiffness(Form::linear, 100, 10), true, true},
          {stiffness(Form::linear, 100, 60), true, true},
          {stiffness(Form::logarithmic, 100, 30), true, true},
          {bounded(50, 20, 20, 150), true, false},
          {bounded(50, 20, 20, 60), true, true},
          {stiffness(Form::linear, 100, 30), true, false},
          {stiffness(Form::linear, -100, 30), false, false}};
}

TEST(PriorLaw, MediansAndQuantilesAreThoseOfTheDistribution) {
  const double u = 1.2815515655446004;  // 90 %
  EXPECT_DOUBLE_EQ(PriorLaw(stiffness(Form::linear, 100, 10), true, true).value(u), 100 + 10 * u);
  EXPECT_NEAR(PriorLaw(stiffness(Form::logarithmic, 100, 30), true, true).value(u), 100 * std::exp(0.3 * u),
              1e-9);
  EXPECT_NEAR(PriorLaw(bounded(50, 20, 20, 150), true, false).value(u), 20 + 0.9 * 130, 1e-9);
  EXPECT_NEAR(PriorLaw(stiffness(Form::linear, 100, 30), true, false).value(u), 10 * std::pow(100, 0.9),
              1e-8);
}

// E p of a normal cut off at zero: mu + s phi(a) / Phi(-a), a = -mu / s.
TEST(PriorLaw, OfANormalCutOffAtZeroHasItsMean) {
  const PriorLaw law(stiffness(Form::linear, 100, 60), true, true);
  double mean = 0.0;
  const double h = 0.001;
  for (double u = -8.0; u < 8.0; u += h)
    mean += h * law.value(u + 0.5 * h) * std::exp(-0.5 * (u + 0.5 * h) * (u + 0.5 * h)) /
            std::sqrt(2 * std::numbers::pi);
  const double a = -100.0 / 60.0;
  EXPECT_NEAR(mean,
              100 + 60 * std::exp(-0.5 * a * a) / std::sqrt(2 * std::numbers::pi) /
                        (0.5 * std::erfc(a / std::sqrt(2.0))),
              1e-4);
}

TEST(PriorLaw, PlacesAreFoundBackAndSlopesAreDifferences) {
  for (const PriorLaw& law : every_law())
    for (const double u : {-4.0, -1.3, 0.0, 0.7, 3.5}) {
      const double p = law.value(u), h = 1e-5;
      ASSERT_TRUE(law.place(p)) << law.text() << " " << u;
      EXPECT_NEAR(*law.place(p), u, 1e-8) << law.text();
      const double slope = (law.value(u + h) - law.value(u - h)) / (2 * h);
      EXPECT_NEAR(law.slope(u), slope, 1e-6 * std::abs(slope) + 1e-9) << law.text() << " " << u;
    }
}

TEST(PriorLaw, HasNoPlaceOutsideItsBounds) {
  const PriorLaw law(bounded(50, 20, 20, 150), true, false);
  EXPECT_FALSE(law.place(155.0));
  EXPECT_FALSE(law.place(20.0));
  EXPECT_FALSE(law.assumed());
}

}  // namespace
}  // namespace beamid::experiments::prior_law_test
