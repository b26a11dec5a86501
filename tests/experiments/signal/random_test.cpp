// Oracle: what independent normal numbers must do.
#include "experiments/signal/toolbox.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beamid::experiments::random_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double four_sigma = 4.0;  // 6e-5 of right generators fail a check; seeds are fixed

TEST(StandardNormal, HasTheMomentsOfTheNormalDistribution) {
  // Oracle: mean 0, variance 1, skewness 0, kurtosis 3; their standard errors over n numbers are
  // sqrt(1/n), sqrt(2/n), sqrt(15/n) about the fixed mean, and sqrt(96/n).
  constexpr Index n = 1'000'000;
  const VectorXd x = standard_normal(n, 2009, 0);
  const double root = std::sqrt(static_cast<double>(n));
  EXPECT_NEAR(x.mean(), 0.0, four_sigma / root);
  EXPECT_NEAR(x.array().square().mean(), 1.0, four_sigma * std::sqrt(2.0) / root);
  EXPECT_NEAR(x.array().cube().mean(), 0.0, four_sigma * std::sqrt(15.0) / root);
  EXPECT_NEAR(x.array().pow(4).mean(), 3.0, four_sigma * std::sqrt(96.0) / root);
}

TEST(StandardNormal, HasTheDistributionFunctionOfTheNormal) {
  // Oracle: Kolmogorov-Smirnov against erfc; its statistic exceeds 1.95 / sqrt(n) once in a thousand.
  constexpr Index n = 200'000;
  VectorXd x = standard_normal(n, 1, 7);
  std::sort(x.begin(), x.end());
  double distance = 0.0;
  for (Index i = 0; i < n; ++i) {
    const double expected = 0.5 * std::erfc(-x[i] / std::numbers::sqrt2);
    distance = std::max({distance, std::abs(expected - static_cast<double>(i) / n),
                         std::abs(expected - static_cast<double>(i + 1) / n)});
  }
  EXPECT_LT(distance, 1.95 / std::sqrt(static_cast<double>(n)));
}

TEST(StandardNormal, IsIndependentBetweenStreamsSeedsAndInstants) {
  // Oracle: the correlation of independent sequences has a standard error of 1/sqrt(n). Streams and seeds
  // that differ in a high word only must differ as much as neighbours.
  constexpr Index n = 200'000;
  const double limit = four_sigma / std::sqrt(static_cast<double>(n));
  const VectorXd x = standard_normal(n, 2009, 3);
  for (const std::uint64_t stream : {std::uint64_t{4}, std::uint64_t{3} | std::uint64_t{1} << 32})
    EXPECT_NEAR(x.dot(standard_normal(n, 2009, stream)) / n, 0.0, limit) << stream;
  for (const std::uint64_t seed : {std::uint64_t{2010}, std::uint64_t{2009} | std::uint64_t{1} << 32})
    EXPECT_NEAR(x.dot(standard_normal(n, seed, 3)) / n, 0.0, limit) << seed;
  for (const Index lag : {1, 2, 3, 100})
    EXPECT_NEAR(x.head(n - lag).dot(x.tail(n - lag)) / static_cast<double>(n - lag), 0.0, 1.01 * limit);
}

TEST(StandardNormal, GivesTheSameNumbersHoweverManyAreAsked) {
  // Oracle: the numbers are a function of seed, stream and position alone.
  const VectorXd many = standard_normal(1001, 5, 9);
  for (const Index count : {0, 1, 2, 3, 500, 1000})
    EXPECT_EQ(standard_normal(count, 5, 9), many.head(count)) << count;
}

}  // namespace
}  // namespace beamid::experiments::random_test
