// Oracles: the conditions by hand; of a step's length the closed form g^-1(e^(lambda dt)) / dt of forward
// Euler and of the classical Runge-Kutta scheme.
#include "experiments/models/estimates.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace beamid::experiments::divergence_test {
namespace {

using testing::HasSubstr;

FoundMode mode(double frequency_hz, double damping_ratio, double deviation = 0.0) {
  FoundMode found;
  found.frequency_hz = frequency_hz;
  found.damping_ratio = damping_ratio;
  found.damping_ratio_deviation = deviation;
  return found;
}

TEST(Divergence, NamesTheConditionThatFailed) {
  EXPECT_EQ(divergence(mode(5.5, 0.004, 1e-5), 5.51), "");
  EXPECT_EQ(divergence(mode(5.5, 0.004, 1e-5), {}), "");
  EXPECT_THAT(divergence(mode(0.0, 0.004, 1e-5), 5.51), HasSubstr("stiffness is not positive"));
  EXPECT_THAT(divergence(mode(std::nan(""), 0.004, 1e-5), {}), HasSubstr("stiffness is not positive"));
  EXPECT_THAT(divergence(mode(5.5, -0.0088, 1e-5), 5.51), HasSubstr("damping ratio is -0.88 %"));
  EXPECT_THAT(divergence(mode(5.5, std::nan(""), 1e-5), 5.51), HasSubstr("damping ratio"));
  EXPECT_THAT(divergence(mode(4.2, 0.004, 1e-5), 5.51), HasSubstr("4.2 Hz where the record has 5.51 Hz"));
}

TEST(Divergence, IsNoNegativeDampingThatIsUnknownWithinItsInterval) {
  EXPECT_EQ(divergence(mode(5.5, -0.001, 0.002), 5.51), "");
}

TEST(Divergence, OfAFailedFilterIsItsFailure) {
  Identification lost;
  lost.found = {1.0, 100.0, 0.1};
  lost.run.failure = filters::Failure{};
  lost.run.failure->step = 12;
  lost.run.failure->reason = "the covariance is not positive";
  EXPECT_THAT(divergence(lost, 10.0 / (2.0 * std::numbers::pi)),
              HasSubstr("sample 12, 0.0000 s: the covariance is not positive"));
  lost.run.failure.reset();
  EXPECT_EQ(divergence(lost, 10.0 / (2.0 * std::numbers::pi)), "");
}

TEST(StepTooLong, SaysWhatTheSchemeMakesOfAModeByItsClosedForm) {
  // forward Euler: lambda_f = (e^(lambda dt) - 1) / dt
  const double omega = 2.0 * std::numbers::pi * 3.4555, ratio = 0.0045, dt = 0.004;
  const std::complex<double> lambda(-ratio * omega, omega * std::sqrt(1.0 - ratio * ratio));
  const std::complex<double> found = (std::exp(lambda * dt) - 1.0) / dt;
  const double expected = -100.0 * found.real() / std::abs(found);
  EXPECT_THAT(step_too_long("forward_euler", mode(3.4555, ratio), dt),
              HasSubstr(fmt::format("{:.3g} %, whatever the filter", expected)));
}

TEST(StepTooLong, IsSilentWhereTheSchemeFollows) {
  EXPECT_EQ(step_too_long("exponential", mode(5.509, 0.004), 1.0 / 12.0), "");
  EXPECT_EQ(step_too_long("runge_kutta_4", mode(5.509, 0.004), 0.001), "");
  EXPECT_EQ(step_too_long("runge_kutta_4", mode(5.509, 0.0), 0.001), "");
  // omega dt = 1.15: a growth of -(omega dt)^5 / 144 in the ratio is 1.4 %
  EXPECT_THAT(step_too_long("runge_kutta_4", mode(5.509, 0.004), 1.0 / 30.0), HasSubstr("step is too long"));
}

}  // namespace
}  // namespace beamid::experiments::divergence_test
