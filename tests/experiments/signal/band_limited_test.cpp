#include "experiments/signal/interpolation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments::band_limited_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr Index count = 1000;

/// Stamps of mean interval 1 that are up to `jitter` early or late.
VectorXd stamps(double jitter) {
  return VectorXd::LinSpaced(count, 0, count - 1) +
         jitter * standard_normal(count, 3, 1).array().tanh().matrix();
}

VectorXd sine(const VectorXd& at, double frequency) {
  return (2 * std::numbers::pi * frequency * at.array() + 0.4).sin();
}

double worst(const VectorXd& time, double frequency) {
  const BandLimited interpolation(time, sine(time, frequency));
  const VectorXd at = VectorXd::LinSpaced(4 * count, time[0], time[count - 1]);
  return (interpolation(at) - sine(at, frequency)).cwiseAbs().maxCoeff();
}

// Oracle: the sine. Ends included.
TEST(BandLimited, ReturnsASineFromJitteredStamps) {
  for (const double jitter : {0.0, 0.1, 0.2, 0.3}) {
    const VectorXd time = stamps(jitter);
    const double rate = BandLimited(time, time).rate();
    for (const double share : {0.05, 0.3, 0.39})
      EXPECT_LT(worst(time, share * rate), 1e-4) << jitter << ", " << share;
  }
}

// Stamps that are late now and then, and noise: more nodes than the widest interval allows made errors of 150
// times the noise between the stamps.
TEST(BandLimited, DoesNotMakeNoiseGrow) {
  constexpr double noise = 0.01;
  const VectorXd draws = standard_normal(2 * count, 7, 0);
  VectorXd time(count);
  time[0] = 0;
  for (Index k = 1; k < count; ++k)
    time[k] = time[k - 1] + 1 + 0.3 * std::tanh(draws[k]) + (draws[count + k] > 1 ? 0.5 : 0);
  const BandLimited interpolation(time, sine(time, 0.02) + noise * standard_normal(count, 8, 0));
  const VectorXd at = VectorXd::LinSpaced(4 * count, time[0], time[count - 1]);
  const VectorXd error = interpolation(at) - sine(at, 0.02);
  EXPECT_LT(error.norm() / std::sqrt(4.0 * count), noise);
  EXPECT_LT(error.cwiseAbs().maxCoeff(), 6 * noise);
}

TEST(BandLimited, TellsItsKernelsError) {
  for (const double frequency : {0.1, 0.2, 0.3, 0.35, 0.4}) {
    EXPECT_LT(BandLimited::kernel_error(frequency), 1e-4);
    const VectorXd time = VectorXd::LinSpaced(count, 0, count - 1);
    EXPECT_LT(worst(time, frequency), 1.2 * BandLimited::kernel_error(frequency) + 1e-5);
  }
  EXPECT_GT(BandLimited::kernel_error(0.47), 0.1);
}

// Oracle: e^(i turn u) against the line between its values at u = 0 and 1, over all u: a sine of any phase is
// a part of it.
TEST(LinearInterpolation, ErrsMostHalfwayBetweenSamples) {
  for (const double frequency : {0.05, 0.16, 0.31, 0.39, 0.47}) {
    const double turn = 2 * std::numbers::pi * frequency;
    double largest = 0;
    for (int part = 0; part <= 1000; ++part) {
      const double u = part / 1000.0;
      largest = std::max(largest, std::abs(1 - u + u * std::polar(1.0, turn) - std::polar(1.0, turn * u)));
    }
    EXPECT_NEAR(linear_interpolation_error(frequency), largest, 1e-12) << frequency;
  }
  EXPECT_NEAR(linear_interpolation_error(0.16), 0.12, 0.005);  // docs/theory/preparation.md
  EXPECT_NEAR(linear_interpolation_error(0.31), 0.44, 0.005);
  EXPECT_NEAR(linear_interpolation_error(0.39), 0.66, 0.005);
}

}  // namespace
}  // namespace beamid::experiments::band_limited_test
