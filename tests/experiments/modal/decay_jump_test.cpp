// A knock in the middle of a decay. Oracle: when and how large it was made.
#include "experiments/modal/decay_jump.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "experiments/signal/toolbox.hpp"
#include "tests/experiments/damped_oscillation.hpp"
#include "tests/experiments/modal/nonlinear_decay.hpp"

namespace beamid::experiments::decay_jump_test {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXd;
using test::complex_rate, test::damped_oscillation;

constexpr double interval = 0.004, frequency_hz = 3.4555, damping_ratio = 0.0045, noise = 0.05, knocked = 8.0;
constexpr Index count = 5000;

VectorXd noise_of(std::uint64_t seed) {
  return noise * standard_normal(count, seed, 0);
}

VectorXd decay(Complex amplitude) {
  return damped_oscillation(amplitude, complex_rate(frequency_hz, damping_ratio), interval, count);
}

/// A decay of 5 m/s2 that a knock multiplies by 1 + j at 8 s.
VectorXd knocked_decay(Complex j) {
  VectorXd signal = decay({3, -4});
  const auto begin = static_cast<Index>(knocked / interval);
  signal.tail(count - begin) += decay(j * Complex(3, -4)).tail(count - begin);
  return signal;
}

std::optional<DecayJump> jump_of(const VectorXd& signal) {
  ModalAnalysisSettings settings;
  settings.expected_frequency_hz = frequency_hz;
  return decay_jump(signal, interval, dominant_mode(signal, interval, settings));
}

TEST(DecayJump, IsFoundWhereAndAsLargeAsItWas) {
  const Complex jumps[] = {{0.05, 0}, {0, 0.05}, {-0.1, 0.05}, {0.5, 0.2}, {-0.6, 0}};
  std::uint64_t seed = 1;
  for (const Complex j : jumps) {
    const auto found = jump_of(knocked_decay(j) + noise_of(seed++));
    ASSERT_TRUE(found && found->motion()) << j;
    EXPECT_NEAR(found->time(), knocked, 1 / frequency_hz) << j;
    EXPECT_NEAR(found->motion()->amplitude_ratio, std::abs(1.0 + j), 0.03) << j;
    EXPECT_NEAR(found->motion()->phase, std::arg(1.0 + j), 0.03) << j;
  }
}

// A sway of a sixth of the amplitude beneath it hides nothing.
TEST(DecayJump, IsFoundAboveASway) {
  const VectorXd time = VectorXd::LinSpaced(count, 0, interval * (count - 1));
  const VectorXd sway = 0.8 * (2 * std::numbers::pi * 0.4 * time.array()).sin();
  EXPECT_TRUE(jump_of(knocked_decay({0.1, 0}) + sway + noise_of(7)));
}

TEST(DecayJump, IsNotFoundWhereNothingHappened) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed)
    EXPECT_FALSE(jump_of(decay({3, -4}) + noise_of(seed))) << seed;
}

// Beats of a second mode, found or not, of many distances and dampings.
TEST(DecayJump, IsNotFoundInBeats) {
  std::uint64_t seed = 1;
  for (const double hz : {3.55, 3.7, 3.9, 4.2, 4.6, 5.2, 6.1})
    for (const double ratio : {0.002, 0.01, 0.03})
      for (const double share : {0.02, 0.05, 0.09, 0.3}) {
        const VectorXd other = damped_oscillation(5 * share, complex_rate(hz, ratio), interval, count);
        EXPECT_FALSE(jump_of(decay({3, -4}) + other + noise_of(seed++)))
            << hz << " Hz, " << ratio << ", " << share;
      }
}

// Damping and frequency that follow the amplitude, with hardly any noise.
TEST(DecayJump, IsNotFoundInSmoothNonlinearity) {
  for (const double power : {0.0, 2.0, 3.0})
    for (const double b : {0.0, -2e-3, 2e-3}) {
      const VectorXd signal =
          test::nonlinear_decay(frequency_hz, damping_ratio, power, b, interval, count) + noise_of(3) / 50;
      EXPECT_FALSE(jump_of(signal)) << power << ", " << b;
    }
}

}  // namespace
}  // namespace beamid::experiments::decay_jump_test
