// How dense the noise is at the mode. Oracle: the density with which it was made.
#include "experiments/identify/verdict/noise_near_mode.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments::noise_near_mode_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double interval = 1.0 / 60, deviation = 0.02;  // of a mode of 1 Hz
constexpr Index count = 1800;

/// A decay of 1 Hz in noise y_k = keep y_(k-1) + e_k of a given deviation.
VectorXd decay(double keep, std::uint64_t seed) {
  constexpr Index settle = 500;
  VectorXd noise = standard_normal(count + settle, seed, 0);
  for (Index k = 1; k < noise.size(); ++k)
    noise[k] = keep * noise[k - 1] + std::sqrt(1 - keep * keep) * noise[k];
  VectorXd signal = deviation * noise.tail(count);
  for (Index k = 0; k < count; ++k) {
    const double t = interval * static_cast<double>(k), w = 2 * std::numbers::pi;
    signal[k] += std::exp(-0.01 * w * t) * std::cos(w * t);
  }
  return signal;
}

struct Means {
  double variance = 0, slope = 0, relative_variance = 0, freedom = 0;
};

Means means(double keep, double true_variance) {
  constexpr int records = 100;
  ModalAnalysisSettings settings;
  settings.expected_frequency_hz = 1.0;
  Means means;
  for (std::uint64_t seed = 1; seed <= records; ++seed) {
    const VectorXd signal = decay(keep, seed);
    const NoiseNearMode found = noise_near_mode(signal, interval, dominant_mode(signal, interval, settings));
    const double ratio = found.deviation * found.deviation / true_variance;
    means.variance += ratio / records;
    means.relative_variance += (ratio - 1) * (ratio - 1) / records;
    means.slope += found.slope / records;
    means.freedom += found.freedom / records;
  }
  return means;
}

// An interval by hardly any line of noise is wide beyond use, and no overflow.
TEST(NoiseNearMode, HasAStudentFactorForAnyFreedom) {
  EXPECT_NEAR(student_factor(1.0), 12.7062 / 1.95996, 1e-4);  // a table's
  EXPECT_GT(student_factor(1e-9), 1e6);
  EXPECT_LT(student_factor(1e-9), 1e15);
}

// Scatter of the mean of 100: sqrt(2 / 47 / 100) = 2.1 %.
TEST(NoiseNearMode, IsThatOfWhiteNoise) {
  const Means found = means(0.0, deviation * deviation);
  EXPECT_NEAR(found.variance, 1.0, 0.07);
  EXPECT_NEAR(found.slope, 0.0, 0.25);
  EXPECT_NEAR(found.relative_variance, 2 / found.freedom, 0.5 * 2 / found.freedom);
}

// Closed form: (1 - a^2) / |1 - a e^(-i w dt)|^2 at the mode, and the slope of its logarithm. The mean over
// the band is 20 % lower, the mean over all frequencies nine times.
TEST(NoiseNearMode, IsThatAtTheModeWhereTheDensityFalls) {
  const double keep = std::exp(-3 * std::numbers::pi * interval);  // corner at 1.5 Hz
  const auto density = [&](double hertz) {
    return (1 - keep * keep) /
           std::norm(1.0 - keep * std::polar(1.0, -2 * std::numbers::pi * hertz * interval));
  };
  const Means found = means(keep, deviation * deviation * density(1.0));
  EXPECT_NEAR(found.variance, 0.97, 0.07);  // curvature: 3 %
  EXPECT_NEAR(found.slope, std::log(density(1.01) / density(0.99)) / std::log(1.01 / 0.99), 0.25);
}

// A short window leaves few lines, and the factor says so.
TEST(NoiseNearMode, IsHardlyKnownFromFewLines) {
  const VectorXd signal = decay(0.0, 7).head(300);
  ModalAnalysisSettings settings;
  settings.expected_frequency_hz = 1.0;
  const NoiseNearMode found = noise_near_mode(signal, interval, dominant_mode(signal, interval, settings));
  EXPECT_LT(found.lines, 8);
  EXPECT_LT(found.freedom, 10);
  EXPECT_NEAR(found.student(),
              boost::math::quantile(boost::math::students_t(found.freedom), 0.975) / 1.959964, 1e-6);
  EXPECT_GT(found.student(), 1.1);
}

}  // namespace
}  // namespace beamid::experiments::noise_near_mode_test
