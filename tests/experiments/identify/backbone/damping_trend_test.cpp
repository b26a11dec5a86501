// Oracles: dampings worked out from the friction or drag put in; constant ones with noise of their stated
// size.
#include "experiments/identify/backbone/secant_curve.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "filters/random.hpp"

namespace beamid::experiments::damping_trend_test {
namespace {

using Kind = DampingTrend::Kind;
constexpr double frequency_hz = 3.42, omega = 2.0 * std::numbers::pi * frequency_hz;

// Twelve windows, each of 0.75 times the amplitude of the one before, C known to 2 %.
template <class Law>
std::vector<AmplitudeWindow> windows_of(const Law& law, std::uint64_t seed) {
  std::vector<AmplitudeWindow> windows;
  const Eigen::MatrixXd noise = filters::RandomStream(seed, 0).normal(12, 1);
  double amplitude = 0.04;
  for (Eigen::Index i = 0; i < 12; ++i, amplitude *= 0.75) {
    AmplitudeWindow w;
    w.amplitude = amplitude, w.frequency_hz = frequency_hz;
    w.damping_deviation = 0.02 * law(amplitude);
    w.damping = law(amplitude) + w.damping_deviation * noise(i, 0);
    windows.push_back(w);
  }
  return windows;
}

TEST(DampingTrend, OfAFrictionIsItsForce) {
  const auto windows =
      windows_of([](double a) { return 0.3 + 4.0 * 0.2 / (std::numbers::pi * omega * a); }, 1);
  const DampingTrend found = damping_trend(windows);
  ASSERT_EQ(found.kind, Kind::friction);
  EXPECT_NEAR(found.coefficient, 0.2, 4.0 * found.deviation);
  EXPECT_NEAR(found.coefficient, 0.2, 0.01);
  EXPECT_THAT(damping_trend_text(found, windows), testing::HasSubstr("dry friction of 0.2"));
}

TEST(DampingTrend, OfADragIsItsCoefficient) {
  const auto windows =
      windows_of([](double a) { return 0.3 + 8.0 * 1.5 * omega * a / (3.0 * std::numbers::pi); }, 2);
  const DampingTrend found = damping_trend(windows);
  ASSERT_EQ(found.kind, Kind::drag);
  EXPECT_NEAR(found.coefficient, 1.5, 0.1);
}

TEST(DampingTrend, ThatRisesAndFallsIsNeither) {
  const auto windows = windows_of([](double a) { return 0.8 + 0.5 * std::sin(3.0 * std::log(a / 0.04)); }, 3);
  EXPECT_EQ(damping_trend(windows).kind, Kind::other);
}

TEST(DampingTrend, IsNoneOfAConstantDamping) {
  for (std::uint64_t seed = 1; seed <= 1000; ++seed)
    EXPECT_EQ(damping_trend(windows_of([](double) { return 0.4; }, seed)).kind, Kind::none) << seed;
}

}  // namespace
}  // namespace beamid::experiments::damping_trend_test
