// A decay whose frequency jumps while the motion goes on. Oracle: when and how much it was made to.
#include "experiments/modal/frequency_jump.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "experiments/modal/decay_jump.hpp"
#include "experiments/signal/toolbox.hpp"
#include "tests/experiments/damped_oscillation.hpp"
#include "tests/experiments/modal/nonlinear_decay.hpp"

namespace beamid::experiments::frequency_jump_test {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXd;
using test::complex_rate, test::damped_oscillation;

constexpr double interval = 0.004, frequency_hz = 3.4555, damping_ratio = 0.0045, noise = 0.05;
constexpr Index count = 4000;

VectorXd noise_of(std::uint64_t seed) {
  return noise * standard_normal(count, seed, 0);
}

VectorXd decay(Complex amplitude, double hz = frequency_hz, double damping = damping_ratio) {
  return damped_oscillation(amplitude, complex_rate(hz, damping), interval, count);
}

/// Sampled at an interval of 1 / ratio of the stamps' from a sample on: the frequency is `ratio` times as
/// high there.
VectorXd at_two_rates(double ratio, Index from) {
  VectorXd signal(count);
  const Complex rate = complex_rate(frequency_hz, damping_ratio);
  for (Index k = 0; k < count; ++k) {
    const double t = interval * (static_cast<double>(std::min(k, from)) +
                                 ratio * static_cast<double>(std::max<Index>(0, k - from)));
    signal[k] = (Complex(3, -4) * std::exp(rate * t)).real();
  }
  return signal;
}

std::optional<DecayJump> decay_jump_of(const VectorXd& signal) {
  ModalAnalysisSettings settings;
  settings.expected_frequency_hz = frequency_hz;
  return decay_jump(signal, interval, dominant_mode(signal, interval, settings));
}

// By a fifth at least (frequency_jump.hpp), or else by a few per cent (decay_jump.cpp).
std::optional<FrequencyJump> jump_of(const VectorXd& signal) {
  const auto found = decay_jump_of(signal);
  return found && found->frequency() ? std::optional(*found->frequency()) : std::nullopt;
}

TEST(FrequencyJump, IsFoundWhereTheSamplingRateChanged) {
  std::uint64_t seed = 1;
  for (const double ratio : {0.25, 0.5, 0.8, 1.25, 2.0, 4.0})
    for (const Index from : {1300, 2100}) {
      const auto found = jump_of(at_two_rates(ratio, from) + noise_of(seed++));
      ASSERT_TRUE(found) << ratio;
      EXPECT_NEAR(found->ratio(), ratio, 0.005 * ratio);
      EXPECT_NEAR(found->before_hz, frequency_hz, 0.005 * frequency_hz) << ratio;
      EXPECT_NEAR(found->time, interval * static_cast<double>(from), 1 / frequency_hz) << ratio;
    }
}

// Something came loose: the intervals of a decay across 2 % held the damping ratio in none of 20 records.
TEST(FrequencyJump, IsFoundWhereItIsOneOfAFewPercent) {
  std::uint64_t seed = 1;
  for (const double ratio : {0.9, 0.95, 0.98, 0.99, 1.01, 1.02, 1.05, 1.1})
    for (const Index from : {1300, 2100}) {
      const auto found = jump_of(at_two_rates(ratio, from) + noise_of(seed++));
      ASSERT_TRUE(found) << ratio << ", " << from;
      EXPECT_NEAR(found->ratio(), ratio, 0.002) << from;
      EXPECT_NEAR(found->time, interval * static_cast<double>(from), 3 / frequency_hz) << ratio;
    }
}

TEST(FrequencyJump, IsWhatADecayJumpsBy) {
  const auto found = decay_jump_of(at_two_rates(2, 2000) + noise_of(1));
  ASSERT_TRUE(found && found->frequency());
  EXPECT_NE(found->sentence(1).find("Hz, 2 times, while the motion goes on"), std::string::npos)
      << found->sentence(1);
}

TEST(FrequencyJump, IsNotFoundWhereNothingHappened) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    EXPECT_FALSE(jump_of(decay({3, -4}) + noise_of(seed))) << seed;
    EXPECT_FALSE(jump_of(decay({3, -4}, frequency_hz, 0.03) + noise_of(seed))) << seed;
    EXPECT_FALSE(jump_of(decay({3, -4}) + 10 * noise_of(seed))) << seed;
  }
}

TEST(FrequencyJump, IsNotFoundAboveASway) {
  const VectorXd time = VectorXd::LinSpaced(count, 0, interval * (count - 1));
  std::uint64_t seed = 1;
  for (const double hz : {0.1, 0.3, 0.4, 0.8})
    for (const double share : {0.2, 0.8, 2.0}) {
      const VectorXd sway = 5 * share * (2 * std::numbers::pi * hz * time.array() + 0.3).sin();
      EXPECT_FALSE(jump_of(decay({3, -4}) + sway + noise_of(seed++))) << hz << " Hz, " << share;
    }
}

// Beats of a second mode, and higher modes that die sooner or later.
TEST(FrequencyJump, IsNotFoundBesideASecondMode) {
  std::uint64_t seed = 1;
  for (const double hz : {1.8, 3.5, 3.55, 3.7, 4.2, 5.2, 7.0, 22.0})
    for (const double ratio : {0.001, 0.03})
      for (const double share : {0.02, 0.2, 1.0}) {
        const VectorXd other = damped_oscillation(5 * share, complex_rate(hz, ratio), interval, count);
        EXPECT_FALSE(jump_of(decay({3, -4}) + other + noise_of(seed++)))
            << hz << " Hz, " << ratio << ", " << share;
      }
}

// From a softening of a third at first to none.
TEST(FrequencyJump, IsNotFoundInAFrequencyThatFollowsTheAmplitude) {
  for (const double power : {0.0, 2.0, 3.0})
    for (const double b : {-1.3e-2, -2e-3, -4e-4, 4e-4, 2e-3}) {
      const VectorXd signal =
          test::nonlinear_decay(frequency_hz, damping_ratio, power, b, interval, count) + noise_of(3) / 5;
      EXPECT_FALSE(jump_of(signal)) << power << ", " << b;
    }
}

}  // namespace
}  // namespace beamid::experiments::frequency_jump_test
