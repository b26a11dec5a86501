#include "experiments/signal/integration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "tests/experiments/damped_oscillation.hpp"

namespace beamid::experiments::integration_test {
namespace {

using Complex = std::complex<double>;
using test::damped_oscillation;
constexpr double interval = 1e-3;

// Oracle: dt/2 (z + 1)/(z - 1), the exact factor of the rule on z^k, up to the constant of integration.
TEST(TrapezoidalIntegral, HasItsExactFactorOnADecay) {
  const Complex rate(-0.3, 40), z = std::exp(rate * interval);
  const Complex factor = trapezoidal_response(rate, interval);
  EXPECT_NEAR(std::abs(factor / (0.5 * interval * (z + 1.0) / (z - 1.0)) - 1.0), 0, 1e-12);
  const Eigen::VectorXd out =
      cumulative_trapezoid(damped_oscillation(1, rate, interval, 3000), interval, factor.real());
  EXPECT_LT((out - damped_oscillation(factor, rate, interval, 3000)).cwiseAbs().maxCoeff(), 1e-13);
}

// Oracle: the rule is exact on straight lines.
TEST(TrapezoidalIntegral, IsExactOnStraightLines) {
  const Eigen::VectorXd line = Eigen::VectorXd::LinSpaced(1001, 0, 2);
  EXPECT_NEAR(cumulative_trapezoid(line, interval)[1000], 1.0, 1e-12);
  EXPECT_EQ(cumulative_trapezoid(line, interval, 4)[0], 4);
}

// Oracle: every stage's factor on e^(s t), multiplied; beam S(119.3) of the study over its 25 s.
TEST(Processing, KeepsFrequencyAndDampingThroughBothIntegrals) {
  const double w = 2 * M_PI * 1.7299;
  const Complex rate(-0.0015 * w, w);
  const Eigen::VectorXd acceleration = damped_oscillation(1.417, rate, interval, 25000);
  for (const bool zero_phase : {false, true}) {
    ProcessingSettings settings;
    settings.zero_phase = zero_phase;
    settings.low_pass_hz = 2.5 * 1.73;
    settings.transient_tolerance = 1e-6;
    const ProcessedMotion motion = process_acceleration(acceleration, interval, settings);
    const CascadedFilter filter = processing_filter(settings, interval);
    const Complex filtering = zero_phase ? zero_phase_response(filter, rate) : response(filter, rate);
    const Complex integral = trapezoidal_response(rate, interval);
    const auto error = [&](const Eigen::VectorXd& history, Complex factor) {
      const Eigen::VectorXd difference = history - damped_oscillation(1.417 * factor, rate, interval, 25000);
      return difference.segment(motion.settled_begin, motion.settled_end - motion.settled_begin)
                 .cwiseAbs()
                 .maxCoeff() /
             std::abs(1.417 * factor);
    };
    ASSERT_LT(motion.settled_begin + 10000, motion.settled_end);
    EXPECT_LT(error(motion.acceleration, filtering), 1e-4);
    EXPECT_LT(error(motion.velocity, filtering * integral), 1e-4);
    EXPECT_LT(error(motion.displacement, filtering * integral * integral), 1e-4);
  }
}

// Noise is integrated twice as well: with the high-pass it stays bounded by its white displacement floor,
// noise sqrt(dt) times the 2-norm of the impulse response of 1/(s^2 + sqrt(2) w s + w^2), 1/sqrt(2 sqrt(2)
// w^3).
TEST(Processing, DoesNotLetNoiseRunAway) {
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal(0, 0.05);
  const Eigen::VectorXd noise = Eigen::VectorXd::NullaryExpr(200000, [&] { return normal(generator); });
  const ProcessedMotion motion = process_acceleration(noise, interval, {});
  const double w = 2 * M_PI * 0.5;
  const double expected = 0.05 * std::sqrt(interval / (2 * std::sqrt(2.0) * w * w * w));
  EXPECT_NEAR(std::sqrt(motion.displacement.squaredNorm() / 200000), expected, 0.1 * expected);
}

TEST(Processing, SaysWhatItDoesNotAccept) {
  ProcessingSettings settings;
  EXPECT_THROW(process_acceleration(Eigen::VectorXd::Ones(1), interval, settings), std::invalid_argument);
  settings.low_pass_hz = 500;
  EXPECT_THROW(process_acceleration(Eigen::VectorXd::Ones(100), interval, settings), std::invalid_argument);
  settings.low_pass_hz.reset();
  const ProcessedMotion motion = process_acceleration(Eigen::VectorXd::Ones(100), interval, settings);
  EXPECT_GE(motion.settled_begin, motion.settled_end);
}

}  // namespace
}  // namespace beamid::experiments::integration_test
