#include "experiments/modal/dominant_mode.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "tests/experiments/damped_oscillation.hpp"

namespace beamid::experiments::dominant_mode_test {
namespace {

using Complex = std::complex<double>;
using test::complex_rate, test::damped_oscillation;

// Oracle: the sine put in, from a rate that is off by 1 % in frequency and a half in damping.
TEST(DampedSineFit, RecoversAnExactSineFromARoughStart) {
  const Complex rate = complex_rate(11.2, 0.013), amplitude(3, -2);
  Eigen::VectorXd signal = damped_oscillation(amplitude, rate, 1e-3, 1500);
  signal.array() += 0.25;
  const DampedSineFit fit = fit_damped_sines(signal, 1e-3, {complex_rate(11.3, 0.006)});
  EXPECT_NEAR(std::abs(fit.sines[0].rate - rate) / std::abs(rate), 0, 1e-12);
  EXPECT_NEAR(std::abs(fit.sines[0].amplitude - amplitude), 0, 1e-10);
  EXPECT_NEAR(fit.offset, 0.25, 1e-11);
  EXPECT_LT(fit.residual_standard_deviation, 1e-11);
  EXPECT_THROW(fit_damped_sines(signal.head(9), 1e-3, {rate}), std::invalid_argument);
  EXPECT_THROW(fit_damped_sines(signal, 1e-3, {Complex(-1, 0)}), std::invalid_argument);
}

// Oracle: the sines put in, two of them 2.3 cycles apart over the signal.
TEST(DampedSineFit, SeparatesTwoCloseSines) {
  const Complex first = complex_rate(22.7, 0.026), second = complex_rate(28.4, 0.025);
  const Eigen::VectorXd signal =
      damped_oscillation(0.12, first, 6e-4, 660) + damped_oscillation(Complex(0, 0.035), second, 6e-4, 660);
  const DampedSineFit fit =
      fit_damped_sines(signal, 6e-4, {complex_rate(22.5, 0.02), complex_rate(28, 0.03)});
  ASSERT_EQ(fit.sines.size(), 2);
  EXPECT_NEAR(std::abs(fit.sines[0].rate - first) / std::abs(first), 0, 1e-9);
  EXPECT_NEAR(std::abs(fit.sines[1].rate - second) / std::abs(second), 0, 1e-9);
  EXPECT_NEAR(std::abs(fit.sines[1].amplitude - Complex(0, 0.035)), 0, 1e-9);
}

// Oracle: the five beams of the 2009 study as single exact modes, 25 s at 1 kHz, and their own parameters.
TEST(DominantMode, IsExactOnExactDecays) {
  const double frequency[] = {4.14551098976, 3.45552719485, 2.51565497735, 2.06820125253, 1.72990165242};
  const double damping[] = {0.002, 0.0045, 0.0028, 0.0022, 0.0015};
  for (int beam = 0; beam < 5; ++beam) {
    const Eigen::VectorXd signal =
        damped_oscillation(-5.0, complex_rate(frequency[beam], damping[beam]), 1e-3, 25000);
    ModalAnalysisSettings settings;
    if (beam % 2 == 0) settings.expected_frequency_hz = 1.1 * frequency[beam];
    const ModalEstimate estimate = dominant_mode(signal, 1e-3, settings);
    EXPECT_NEAR(estimate.frequency_hz / frequency[beam], 1, 1e-11);
    EXPECT_NEAR(estimate.damping_ratio / damping[beam], 1, 1e-8);
    EXPECT_NEAR(estimate.realised_damping_ratio / damping[beam], 1, 1e-6);
    EXPECT_NEAR(estimate.amplitude, 5, 1e-9);
    EXPECT_NEAR(std::abs(estimate.phase), std::numbers::pi, 1e-8);
    EXPECT_NEAR(std::abs(estimate.rate() - complex_rate(frequency[beam], damping[beam])), 0, 1e-9);
  }
}

// Oracle: beam S(0.65) of the study, whose second mode is as strong in acceleration (7.915 and 7.577 m/s2),
// with sensor noise and bias: the first mode's parameters, within the standard deviations that the estimate
// reports. The noise found must be the sensor's although the second mode is left in the residual.
TEST(DominantMode, IsNotMisledByAStrongHigherMode) {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal(0, 0.05);
  Eigen::VectorXd signal = damped_oscillation(7.915, complex_rate(4.145511, 0.002), 1e-3, 25000) +
                           damped_oscillation(-7.577, complex_rate(25.99, 0.005), 1e-3, 25000) +
                           Eigen::VectorXd::NullaryExpr(25000, [&] { return normal(generator); });
  signal.array() += 0.3;
  ModalAnalysisSettings settings;
  settings.expected_frequency_hz = 4.2;
  const ModalEstimate estimate = dominant_mode(signal, 1e-3, settings);
  EXPECT_NEAR(estimate.frequency_hz, 4.145511, 4 * estimate.frequency_standard_deviation_hz);
  EXPECT_NEAR(estimate.damping_ratio, 0.002, 4 * estimate.damping_ratio_standard_deviation);
  EXPECT_NEAR(estimate.offset, 0.3, 0.01);
  EXPECT_NEAR(estimate.noise_standard_deviation, 0.05, 0.01);
  EXPECT_GT(estimate.residual_standard_deviation, 0.5);
}

// Oracle: the standard deviations reported, over 100 seeded records; they are the Cramer-Rao bound, so their
// mean square ratio to the true errors tests efficiency and honesty at once (99.9 % band of chi^2 with 100).
TEST(DominantMode, ReportsTheStandardDeviationsItHas) {
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal(0, 0.2);
  const Eigen::VectorXd clean = damped_oscillation(Complex(1, 1), complex_rate(10, 0.01), 2e-3, 1500);
  double frequency = 0, damping = 0;
  for (int run = 0; run < 100; ++run) {
    const ModalEstimate estimate =
        dominant_mode(clean + Eigen::VectorXd::NullaryExpr(1500, [&] { return normal(generator); }), 2e-3);
    frequency += std::pow((estimate.frequency_hz - 10) / estimate.frequency_standard_deviation_hz, 2) / 100;
    damping += std::pow((estimate.damping_ratio - 0.01) / estimate.damping_ratio_standard_deviation, 2) / 100;
    EXPECT_NEAR(estimate.residual_standard_deviation, 0.2, 0.02);
  }
  RecordProperty("frequency", std::to_string(frequency));
  RecordProperty("damping", std::to_string(damping));
  EXPECT_GT(frequency, 0.6);
  EXPECT_LT(frequency, 1.55);
  EXPECT_GT(damping, 0.6);
  EXPECT_LT(damping, 1.55);
}

TEST(DominantMode, NamesWhatItFoundWhenNoModeIsThere) {
  const Eigen::VectorXd signal = damped_oscillation(1, complex_rate(10, 0.01), 2e-3, 1500);
  ModalAnalysisSettings settings;
  settings.expected_frequency_hz = 30;
  try {
    dominant_mode(signal, 2e-3, settings);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "no mode within 25 % of 30 Hz; found 10 Hz");
  }
  EXPECT_THROW(dominant_mode(signal.head(20), 2e-3), std::invalid_argument);
  EXPECT_THROW(dominant_mode(signal * std::nan(""), 2e-3), std::invalid_argument);
  settings.expected_frequency_hz = 250;
  EXPECT_THROW(dominant_mode(signal, 2e-3, settings), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::dominant_mode_test
