#include "experiments/modal/classic_estimators.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace beamid::experiments::logarithmic_decrement_test {
namespace {

Eigen::VectorXd decay(double frequency_hz, double damping_ratio, double offset, double interval,
                      Eigen::Index count) {
  const double w = 2 * std::numbers::pi * frequency_hz,
               w_d = w * std::sqrt(1 - damping_ratio * damping_ratio);
  Eigen::VectorXd signal(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double time = interval * static_cast<double>(k);
    signal[k] = offset + 2 * std::exp(-damping_ratio * w * time) * std::cos(w_d * time + 0.4);
  }
  return signal;
}

// Oracle: the sine put in; what is left is the parabola's error.
TEST(LogarithmicDecrement, IsExactToTheInterpolationOnADecay) {
  for (const double damping : {0.002, 0.013, 0.05})
    for (const double offset : {0.0, 0.1}) {
      const DecrementEstimate estimate =
          logarithmic_decrement(decay(11.2, damping, offset, 6e-4, 2000), 6e-4);
      EXPECT_NEAR(estimate.frequency_hz / 11.2, 1, 1e-5);
      EXPECT_NEAR(estimate.damping_ratio / damping, 1, 2e-3);
      EXPECT_NEAR(estimate.decrement, 2 * std::numbers::pi * damping / std::sqrt(1 - damping * damping),
                  2e-3 * estimate.decrement);
    }
}

// Oracle: the sine put in, within the standard deviation the regression reports; noise of 2 % of the start.
TEST(LogarithmicDecrement, StandsNoise) {
  std::mt19937_64 generator(2);
  std::normal_distribution<double> normal(0, 0.04);
  const Eigen::VectorXd signal = decay(11.2, 0.013, 0, 6e-4, 2500) +
                                 Eigen::VectorXd::NullaryExpr(2500, [&] { return normal(generator); });
  const DecrementEstimate estimate = logarithmic_decrement(signal, 6e-4);
  EXPECT_NEAR(estimate.frequency_hz, 11.2, 0.02);
  EXPECT_NEAR(estimate.damping_ratio, 0.013, 0.05 * 0.013);
  EXPECT_NEAR(estimate.damping_ratio, 0.013, 4 * estimate.damping_ratio_standard_deviation);
}

TEST(LogarithmicDecrement, RefusesTooFewPeaks) {
  try {
    logarithmic_decrement(decay(1, 0.01, 0, 1e-3, 1300), 1e-3);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "logarithmic decrement of 1300 samples: found 2 peaks; expected at least 4");
  }
  EXPECT_THROW(logarithmic_decrement(Eigen::VectorXd(), 1e-3), std::invalid_argument);
  EXPECT_THROW(logarithmic_decrement(Eigen::VectorXd::Ones(100), 1e-3), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::logarithmic_decrement_test
