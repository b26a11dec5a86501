// The intervals of `identify` with higher modes and coloured noise. Oracle: the truth that was simulated.
#include "experiments/studies/efficiency/interval_coverage.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/binomial.hpp>
#include <cmath>

namespace beamid::experiments::interval_coverage_test {
namespace {

// 95 % of independent records, binomial band of 99.9 %.
TEST(IntervalCoverage, IsWhatTheIntervalsSay) {
  CoverageSettings settings;
  settings.runs = 40;
  const boost::math::binomial distribution(settings.runs, 0.95);
  for (const CoverageCase& one : interval_coverage(settings, [](const std::string&) {}).cases) {
    EXPECT_EQ(one.failed, 0) << to_string(one.colour);
    for (std::size_t q = 0; q < one.inside.size(); ++q) {
      EXPECT_GE(one.inside[q], quantile(distribution, 0.0005)) << to_string(one.colour) << ' ' << q;
      // squares have a variance of 2: 3.9 standard errors of six means
      EXPECT_NEAR(one.mean_square[q], 1.0, 3.9 * std::sqrt(2.0 / settings.runs))
          << to_string(one.colour) << ' ' << q;
      EXPECT_NEAR(one.mean[q], 0.0, 3.9 * std::sqrt(1.0 / settings.runs))
          << to_string(one.colour) << ' ' << q;
    }
  }
}

TEST(IntervalCoverage, RefusesASingleRun) {
  CoverageSettings settings;
  settings.runs = 1;
  EXPECT_THROW(interval_coverage(settings, [](const std::string&) {}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::interval_coverage_test
