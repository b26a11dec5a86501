#include "experiments/signal/decimation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/signal/spectrum.hpp"
#include "tests/experiments/damped_oscillation.hpp"

namespace beamid::experiments::decimation_test {
namespace {

using Complex = std::complex<double>;
using test::damped_oscillation;
constexpr double interval = 1e-3;

// Oracle: the decay itself, times the kernel's factor, at the instants kept; from the very first sample.
TEST(Decimation, KeepsADecayExactlyFromTheFirstSample) {
  const Complex rate(-0.4, 26), amplitude(1, -0.7);
  for (const int factor : {1, 2, 7, 30}) {
    const DecimatedSignal out =
        decimate(damped_oscillation(amplitude, rate, interval, 2000), interval, factor);
    const Eigen::VectorXd expected =
        damped_oscillation(amplitude * out.response(rate), rate, out.interval, out.samples.size(), out.start);
    EXPECT_LT((out.samples - expected).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_DOUBLE_EQ(out.interval, factor * interval);
  }
}

// Oracle: the design, 60 dB down from 0.7 of the new sampling rate on and flat to 0.3 of it.
TEST(Decimation, PassesAndStopsAsDesigned) {
  const DecimatedSignal out = decimate(Eigen::VectorXd::Ones(2000), interval, 10);
  const auto gain = [&](double part) {
    return std::abs(out.response(Complex(0, 2 * std::numbers::pi * part / out.interval)));
  };
  for (double part = 0; part < 0.3; part += 0.01) EXPECT_NEAR(gain(part), 1, 1.2e-3) << part;
  for (double part = 0.7; part < 5; part += 0.01) EXPECT_LT(gain(part), 1.2e-3) << part;
}

TEST(Decimation, RefusesTooShortASignal) {
  EXPECT_THROW(decimate(Eigen::VectorXd::Ones(100), interval, 10), std::invalid_argument);
  EXPECT_THROW(decimate(Eigen::VectorXd::Ones(100), interval, 0), std::invalid_argument);
}

// A frequency far below what the record can show asks for more than all samples, and more than an int holds.
TEST(Decimation, LeavesASampleAtLeast) {
  EXPECT_EQ(decimation_factor(7.9, 100), 7);
  EXPECT_EQ(decimation_factor(0.2, 100), 1);
  EXPECT_EQ(decimation_factor(1e30, 100), 100);
  EXPECT_EQ(decimation_factor(1e30, 0), 1);
}

// Oracle: the sine's own frequency; a tenth of a bin is the parabola's error.
TEST(Spectrum, FindsTheStrongestFrequency) {
  Eigen::VectorXd signal =
      damped_oscillation(1, Complex(-0.1, 2 * std::numbers::pi * 13.37), interval, 5000) +
      damped_oscillation(0.4, Complex(0, 2 * std::numbers::pi * 90), interval, 5000);
  signal.array() += 20;
  EXPECT_NEAR(strongest_frequency(signal, interval), 13.37, 0.01);
  // A step has its largest line where the search begins: no frequency below that, and none below zero.
  Eigen::VectorXd step = Eigen::VectorXd::Zero(4000);
  step.tail(3000).setOnes();
  EXPECT_GE(strongest_frequency(step, interval), 1.0 / (4000 * interval));
  EXPECT_THROW(strongest_frequency(Eigen::VectorXd::Ones(64), interval), std::invalid_argument);
  EXPECT_THROW(strongest_frequency(Eigen::VectorXd::Ones(8), interval), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::decimation_test
