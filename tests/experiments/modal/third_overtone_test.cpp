// A sensor that saturates softly. Oracle: the Fourier series of its characteristic.
#include "experiments/modal/amplitude_dependence.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/signal/toolbox.hpp"
#include "tests/experiments/damped_oscillation.hpp"

namespace beamid::experiments::third_overtone_test {
namespace {

using Eigen::Index, Eigen::VectorXd;
using test::complex_rate, test::damped_oscillation;

constexpr double interval = 0.004, frequency_hz = 3.4555, damping_ratio = 0.0045, amplitude = 5, noise = 0.05;

VectorXd noise_of(Index count, std::uint64_t seed) {
  return noise * standard_normal(count, seed, 0);
}

VectorXd decay(Index count) {
  return damped_oscillation({3, -4}, complex_rate(frequency_hz, damping_ratio), interval, count);
}

ModalEstimate mode_of(const VectorXd& signal) {
  ModalAnalysisSettings settings;
  settings.expected_frequency_hz = frequency_hz;
  return dominant_mode(signal, interval, settings);
}

// y = x - b x^3: the mode's amplitude is less by e = 3/4 b A^2, and so is the damping ratio over the decay.
TEST(ThirdOvertone, TellsTheCompressionOfACubicCharacteristic) {
  for (const double e : {0.02, 0.1, -0.05}) {
    const double b = e / (0.75 * amplitude * amplitude);
    const VectorXd x = decay(5000), y = x.array() - b * x.array().cube() + noise_of(5000, 1).array();
    const ModalEstimate mode = mode_of(y);
    const auto found = third_overtone(y, interval, mode);
    ASSERT_TRUE(found) << e;
    EXPECT_NEAR(found->compression, e / (1 - e), 0.15 * std::abs(e)) << e;
    EXPECT_NEAR(found->damping_error(), mode.damping_ratio / damping_ratio - 1, 0.25 * std::abs(e)) << e;
  }
}

// Half a second of tanh behind a sway, and beside a mode, that put some of their own around it.
TEST(ThirdOvertone, IsFoundBesideASwayAndAMode) {
  for (const Index count : {1500, 5000})
    for (const bool swaying : {false, true}) {
      const VectorXd time = VectorXd::LinSpaced(count, 0, interval * static_cast<double>(count - 1));
      VectorXd x = decay(count);
      if (swaying)
        x.array() += 0.8 * (2 * std::numbers::pi * 0.4 * time.array()).sin();
      else
        x += damped_oscillation(1, complex_rate(3.9, 0.004), interval, count);
      const VectorXd y = 4 * (x.array() / 4).tanh() + noise_of(count, 2).array();
      EXPECT_TRUE(third_overtone(y, interval, mode_of(y))) << count << swaying;
    }
}

TEST(ThirdOvertone, IsNotFoundInLinearDecays) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const VectorXd y = decay(3000) + noise_of(3000, seed);
    EXPECT_FALSE(third_overtone(y, interval, mode_of(y))) << seed;
  }
}

// A mode of its own near three times the frequency has another phase, frequency or damping.
TEST(ThirdOvertone, IsNotFoundInAModeNearIt) {
  for (const double off : {0.97, 1.003, 1.02}) {
    const VectorXd other = damped_oscillation({0, 0.4}, complex_rate(3 * off * frequency_hz, 0.01), interval,
                                              5000),
                   y = decay(5000) + other + noise_of(5000, 5);
    EXPECT_FALSE(third_overtone(y, interval, mode_of(y))) << off;
  }
}

}  // namespace
}  // namespace beamid::experiments::third_overtone_test
