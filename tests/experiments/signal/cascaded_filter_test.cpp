#include "experiments/signal/butterworth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/experiments/damped_oscillation.hpp"

namespace beamid::experiments::cascaded_filter_test {
namespace {

using Complex = std::complex<double>;
using test::damped_oscillation;
constexpr double interval = 1e-3;

// Oracle: H(e^(s dt)) e^(s t), exact once the transient is gone.
TEST(CausalFilter, KeepsFrequencyAndDampingOfADecay) {
  const Complex rate(-0.05, 25), amplitude(2, 1);
  const CascadedFilter filter =
      cascade(butterworth_high_pass(2, 0.5, interval), butterworth_low_pass(4, 20, interval));
  const Eigen::Index settled = settling_samples(filter, 1e-9), count = settled + 5000;
  const Eigen::VectorXd out = filter_causally(filter, damped_oscillation(amplitude, rate, interval, count));
  const Eigen::VectorXd expected =
      damped_oscillation(amplitude * response(filter, rate), rate, interval, count);
  EXPECT_LT((out - expected).tail(5000).cwiseAbs().maxCoeff(), 1e-8);
}

// Oracle: the transient's own definition, |r|^n at the slowest pole: 2.22 1/s for 0.5 Hz and order 2.
TEST(CausalFilter, SettlesWhenItSays) {
  const CascadedFilter filter = butterworth_high_pass(2, 0.5, interval);
  EXPECT_NEAR(static_cast<double>(settling_samples(filter, 1e-3)) * interval, std::log(1e3) / 2.2214, 0.01);
  const Complex rate(-0.05, 25);
  const Eigen::Index count = 20000;
  const Eigen::VectorXd error = filter_causally(filter, damped_oscillation(1, rate, interval, count)) -
                                damped_oscillation(response(filter, rate), rate, interval, count);
  for (const double tolerance : {1e-2, 1e-3, 1e-5})
    EXPECT_LT(error.tail(count - settling_samples(filter, tolerance)).cwiseAbs().maxCoeff(), tolerance);
}

TEST(CausalFilter, PassesAConstantWithoutTransientFromASteadyStart) {
  const Eigen::VectorXd constant = Eigen::VectorXd::Constant(500, 3.0);
  const CascadedFilter low = butterworth_low_pass(5, 20, interval),
                       high = butterworth_high_pass(3, 20, interval);
  EXPECT_LT((filter_causally(low, constant, FilterStart::steady) - constant).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT(filter_causally(high, constant, FilterStart::steady).cwiseAbs().maxCoeff(), 1e-10);
}

// Oracle: |H|^2 and no phase for an undamped sine; H(z) H(1/z) for a decay.
TEST(ZeroPhaseFilter, ShiftsNoPhase) {
  const CascadedFilter filter = butterworth_high_pass(2, 0.5, interval);
  const Eigen::Index count = 30000, end = settling_samples(filter, 1e-9);
  for (const Complex rate : {Complex(0, 12), Complex(-0.03, 12)}) {
    const Complex factor = zero_phase_response(filter, rate);
    if (rate.real() == 0) {
      EXPECT_NEAR(std::arg(factor), 0, 1e-9);
      EXPECT_NEAR(std::abs(factor), std::norm(response(filter, rate)), 1e-9);
    }
    const Eigen::VectorXd error =
        filter_forward_backward(filter, damped_oscillation(Complex(1, 2), rate, interval, count)) -
        damped_oscillation(factor * Complex(1, 2), rate, interval, count);
    EXPECT_LT(error.segment(end, count - 2 * end).cwiseAbs().maxCoeff(), 1e-7);
  }
}

// Oracle: a low-pass leaves straight lines alone, a high-pass of order 2 removes them.
TEST(ZeroPhaseFilter, TreatsTheEndsOfStraightLines) {
  const Eigen::VectorXd line = Eigen::VectorXd::LinSpaced(4000, 5, -3);
  EXPECT_LT(
      (filter_forward_backward(butterworth_low_pass(4, 20, interval), line) - line).cwiseAbs().maxCoeff(),
      1e-5);
  EXPECT_LT(filter_forward_backward(butterworth_high_pass(2, 20, interval), line).cwiseAbs().maxCoeff(),
            1e-5);
}

// A decay that starts at the first sample is not odd about it: the transient is there, and only where
// promised.
TEST(ZeroPhaseFilter, ContaminatesTheEndsOfADecayAndOnlyThem) {
  const CascadedFilter filter = butterworth_high_pass(2, 0.5, interval);
  const Complex rate(-0.05, 25);
  const Eigen::Index count = 25000, end = settling_samples(filter, 1e-3);
  const Eigen::VectorXd error =
      filter_forward_backward(filter, damped_oscillation(1, rate, interval, count)) -
      damped_oscillation(zero_phase_response(filter, rate), rate, interval, count);
  EXPECT_GT(error.head(end).cwiseAbs().maxCoeff(), 0.02);
  EXPECT_LT(error.segment(end, count - 2 * end).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(CascadedFilter, RefusesWhatMakesNoSense) {
  const CascadedFilter filter = butterworth_high_pass(2, 0.5, interval);
  EXPECT_THROW(cascade(filter, butterworth_low_pass(2, 5, 2 * interval)), std::invalid_argument);
  EXPECT_THROW(settling_samples(filter, 1), std::invalid_argument);
  EXPECT_THROW(settling_samples({{{1, 0, 0, -2, 1}}, interval}), std::invalid_argument);
  EXPECT_THROW(filter_forward_backward(filter, Eigen::VectorXd::Ones(1)), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::cascaded_filter_test
