// Damping ratio and frequency against amplitude, on decays whose dependence is known in closed form.
#include "experiments/modal/amplitude_dependence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/modal/study/modal_study.hpp"
#include "experiments/signal/toolbox.hpp"
#include "tests/experiments/modal/nonlinear_decay.hpp"

namespace beamid::experiments::amplitude_dependence_test {
namespace {

constexpr double pi = std::numbers::pi;

// m x'' + c x' + K x + F sign(x') = 0 half cycle by half cycle: between two reversals it is linear about F /
// K. Oracle: a cycle loses 4 F A to friction and pi c w A^2 to the damper, so that the friction damps as c_eq
// = 4 F / (pi w A) does: damping ratio = viscous + 2 F / (pi K A).
TEST(AmplitudeDependence, FindsCoulombFriction) {
  constexpr double f = 8, ratio = 0.004, slip = 1e-3, interval = 1e-3;  // slip = F / K
  const double w = 2 * pi * f, turn = w * std::sqrt(1 - ratio * ratio), half = pi / turn;
  Eigen::VectorXd signal(10000);
  double peak = 1, begin = 0, side = 1;
  const Eigen::VectorXd noise = standard_normal(signal.size(), 1, 1);
  for (Eigen::Index k = 0; k < signal.size(); ++k) {
    double t = static_cast<double>(k) * interval - begin;
    while (t >= half) {
      peak = (peak - slip) * std::exp(-ratio * w * half) - slip;
      begin += half;
      t -= half;
      side = -side;
    }
    signal[k] = side * (slip + (peak - slip) * std::exp(-ratio * w * t) *
                                   (std::cos(turn * t) + ratio * w / turn * std::sin(turn * t))) +
                1e-3 * noise[k];
  }
  const auto points = amplitude_dependence(signal, interval, {-0.006 * w, w}, {});
  ASSERT_GE(points.size(), 8u);
  EXPECT_LT(points.back().amplitude, 0.15 * points.front().amplitude);
  double squares = 0;
  for (const AmplitudePoint& point : points) {
    const double expected = ratio + 2 * slip / (pi * point.amplitude);
    EXPECT_NEAR(point.damping_ratio, expected, 0.01 * expected + 4 * point.damping_ratio_deviation);
    EXPECT_NEAR(point.frequency_hz, f, 4 * point.frequency_deviation_hz + 1e-4 * f);
    squares += std::pow((point.damping_ratio - expected) / point.damping_ratio_deviation, 2);
  }
  EXPECT_LT(squares / static_cast<double>(points.size()), 4);  // deviations mean something
}

// x'' + 2 xi w x' + c2 x' |x'| + w^2 x + k3 x^3 = 0 by the classical Runge-Kutta method. Oracles, by harmonic
// balance: damping ratio = xi + 4 c2 A / (3 pi), as a cycle loses 8/3 c2 w^2 A^3 to the quadratic term;
// frequency = f (1 + 3 k3 A^2 / (8 w^2)), the backbone of Duffing's equation.
TEST(AmplitudeDependence, FindsQuadraticDampingAndDuffingsBackbone) {
  constexpr double f = 8, xi = 0.004, c2 = 0.02, interval = 5e-4;
  const double w = 2 * pi * f, k3 = 0.015 * w * w;
  const auto acceleration = [&](double x, double v) {
    return -2 * xi * w * v - c2 * v * std::abs(v) - w * w * x - k3 * x * x * x;
  };
  Eigen::VectorXd signal(16000);
  double x = 1, v = 0;
  for (Eigen::Index k = 0; k < signal.size(); ++k) {
    signal[k] = x;
    const double h = interval, a1 = acceleration(x, v), v2 = v + h / 2 * a1,
                 a2 = acceleration(x + h / 2 * v, v2), v3 = v + h / 2 * a2,
                 a3 = acceleration(x + h / 2 * v2, v3), v4 = v + h * a3, a4 = acceleration(x + h * v3, v4);
    x += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  const auto points = amplitude_dependence(signal, interval, {-0.008 * w, w}, {});
  ASSERT_GE(points.size(), 8u);
  EXPECT_GT(points.front().frequency_hz / points.back().frequency_hz, 1.003);
  for (const AmplitudePoint& point : points) {
    const double a = point.amplitude, expected = xi + 4 * c2 * a / (3 * pi);
    EXPECT_NEAR(point.damping_ratio, expected, 0.02 * expected);
    EXPECT_NEAR(point.frequency_hz, f * (1 + 3 * k3 * a * a / (8 * w * w)), 2e-4 * f);
  }
}

// Oracle: the two modes that the signal is made of; the weaker one is beside an offset and a stronger mode.
TEST(AmplitudeDependence, KeepsModesApart) {
  Eigen::VectorXd signal(8000);
  const double w1 = 2 * pi * 6.6, w2 = 2 * pi * 9.5;
  for (Eigen::Index k = 0; k < signal.size(); ++k) {
    const double t = 1e-3 * static_cast<double>(k);
    signal[k] = std::exp(-0.01 * w1 * t) * std::cos(w1 * t) +
                0.1 * std::exp(-0.005 * w2 * t) * std::sin(w2 * t) + 0.5;
  }
  const auto points =
      amplitude_dependence(signal, 1e-3, {-0.005 * w2, w2}, {{-0.01 * w1, w1}, {-0.005 * w2, w2}});
  ASSERT_GE(points.size(), 3u);
  for (const AmplitudePoint& point : points) {
    EXPECT_NEAR(point.damping_ratio, 0.005, 1e-4);
    EXPECT_NEAR(point.frequency_hz, 9.5 / std::sqrt(1 - 0.005 * 0.005), 2e-3);
    EXPECT_NEAR(point.amplitude, 0.1 * std::exp(-0.005 * w2 * point.time), 2e-3);
  }
}

// A mode whose frequency falls by 2.5 % with its amplitude, 1 + b A^2 with b A_0^2 = 0.025, beside a constant
// one that is stronger at first, and a motion of a fifth of its damping time near its frequency. Oracle: what
// was simulated.
TEST(AmplitudeDependence, IsNamedOfTheWeakerModeBehindOtherMotion) {
  constexpr double interval = 1e-3, f = 20;
  const Eigen::Index count = 4000;
  Record record;
  record.time = Eigen::VectorXd::LinSpaced(count, 0, interval * static_cast<double>(count - 1));
  record.samples = test::nonlinear_decay(f, 0.012, 1, 1e-3, interval, count).transpose();
  record.channels = {{Quantity::acceleration, "tip"}};
  const Eigen::VectorXd noise = standard_normal(count, 6, 1);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double t = interval * static_cast<double>(k);
    record.samples(0, k) += 8 * std::exp(-10 * t) * std::cos(2 * pi * 187 * t) +
                            4 * std::exp(-15 * t) * std::cos(2 * pi * 24.8 * t) + 2e-3 * noise[k];
  }
  const RecordModes found = find_modes("a", record, false, {});
  const auto of_f = [&](const Objection& one) {
    return one.name == "amplitude_dependent" && one.text.find("The mode at 20") != std::string::npos;
  };
  EXPECT_EQ(std::ranges::count_if(found.objections, of_f), 1);
  const auto mode = std::ranges::min_element(
      found.modes, {}, [&](const ModeEstimate& one) { return std::abs(one.pole.frequency_hz() - f); });
  ASSERT_NE(mode, found.modes.end());
  EXPECT_NEAR(mode->pole.frequency_hz(), f, 2 * mode->pole.frequency_deviation_hz);
}

// A motion whose frequency drifts by 5 %, and its cube: an overtone that follows. A mode near three times the
// frequency does not. Oracle: cos^3 = (3 cos + cos 3) / 4.
TEST(OvertoneCoherence, TellsAnOvertoneFromAMode) {
  constexpr double f = 5, interval = 1e-3;
  const Eigen::Index count = 8000;
  const Eigen::VectorXd noise = standard_normal(count, 4, 1);
  Eigen::VectorXd overtone(count), mode(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) * interval, a = std::exp(-0.3 * t),
                 phase = 2 * pi * f * (t - 0.05 * (1 - std::exp(-0.6 * t)) / 0.6), x = a * std::cos(phase);
    overtone[k] = x + 0.2 * x * x * x + 1e-3 * noise[k];
    mode[k] = x + 0.05 * std::exp(-0.4 * t) * std::cos(2 * pi * 3.08 * f * t) + 1e-3 * noise[k];
  }
  EXPECT_GT(overtone_coherence(overtone, interval, f, 3), 0.95);
  EXPECT_LT(overtone_coherence(mode, interval, f, 3), 0.5);
}

}  // namespace
}  // namespace beamid::experiments::amplitude_dependence_test
