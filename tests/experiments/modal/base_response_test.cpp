// Oracle: the oscillators that made the motion, integrated in closed form here.
#include "experiments/modal/channel_fault.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

namespace beamid::experiments::base_response_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double interval = 0.01;

// White acceleration of the base, quiet at both ends.
VectorXd shaking(Index samples, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  VectorXd base(samples);
  double smooth = 0.0;
  for (Index k = 0; k < samples; ++k) {
    smooth = 0.7 * smooth + normal(generator);
    const double t = static_cast<double>(k) / static_cast<double>(samples);
    base[k] = smooth * std::pow(std::sin(std::numbers::pi * t), 2);
  }
  return base;
}

// y = u + sum_j G_j a_j, a_j'' of the relative motion of an oscillator under -u that runs straight between
// its samples: s' = lambda s - u exactly.
VectorXd response_to(const VectorXd& base, const std::vector<std::array<double, 3>>& modes) {
  VectorXd response = base;
  for (const auto& [frequency, ratio, participation] : modes) {
    const double w = 2.0 * std::numbers::pi * frequency, damped = w * std::sqrt(1.0 - ratio * ratio);
    const std::complex<double> rate(-ratio * w, damped), e = std::exp(rate * interval);
    const std::complex<double> first = (e - 1.0) / rate, second = (first - interval) / (rate * interval);
    std::complex<double> s = 0.0;
    for (Index k = 0; k < base.size(); ++k) {
      const double displacement = s.imag() / damped, velocity = (rate * s).imag() / damped;
      response[k] += participation * (-base[k] - 2.0 * ratio * w * velocity - w * w * displacement);
      const double further = k + 1 < base.size() ? base[k + 1] : 0.0;
      s = e * s - first * base[k] - second * (further - base[k]);
    }
  }
  return response;
}

TEST(BaseResponse, FindsTheFirstModeOfAColumn) {
  const VectorXd base = shaking(6000, 1);
  const VectorXd response = response_to(base, {{2.5, 0.05, 1.25}, {5.6, 0.11, -0.35}, {8.3, 0.17, 0.1}});
  const BaseResponse found = base_response(base, response, interval, {});
  EXPECT_NEAR(found.frequency_hz, 2.5, 0.02);
  EXPECT_NEAR(found.damping_ratio, 0.05, 0.004);
  EXPECT_NEAR(found.participation, 1.25, 0.06);
}

TEST(BaseResponse, OfOneModeIsExact) {
  const VectorXd base = shaking(6000, 2);
  const BaseResponse found = base_response(base, response_to(base, {{2.5, 0.05, 1.0}}), interval, {});
  EXPECT_NEAR(found.frequency_hz, 2.5, 2.5e-3);
  EXPECT_NEAR(found.damping_ratio, 0.05, 1e-3);
}

TEST(BaseResponse, StatesDeviationsThatHold) {
  // Noise of 5 % at both; 40 records, so that the mean square is known to 0.32.
  double squares = 0.0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    VectorXd base = shaking(6000, 10 + seed), response = response_to(base, {{2.5, 0.05, 1.0}});
    std::mt19937 generator(100 + seed);
    std::normal_distribution<double> normal(0.0, 0.05 * std::sqrt(response.squaredNorm() / 6000.0));
    for (Index k = 0; k < 6000; ++k) response[k] += normal(generator);
    const BaseResponse found = base_response(base, response, interval, {});
    squares += std::pow((found.frequency_hz - 2.5) / found.frequency_deviation_hz, 2) / 40.0;
  }
  EXPECT_GT(squares, 0.4);
  EXPECT_LT(squares, 1.6);
}

TEST(BaseResponse, RefusesMotionThatIsNotOfThisBase) {
  EXPECT_THROW(base_response(shaking(6000, 3), shaking(6000, 4), interval, {}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::base_response_test
