// Stiffness and damping from a free decay: exact data, honest deviations, units, a start that is not right.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "beamid/testing/every_filter.hpp"
#include "filters/diagnostics.hpp"

namespace beamid::test::identification {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::Gaussian;

TEST_P(EveryFilter, IdentifiesWithoutNoiseToSixDigits) {
  // Oracle: the parameters that made the record. Consistent filters promise it too.
  if (linear_only()) GTEST_SKIP() << "the model is not linear";
  if (!declares(filters::contract::identifies) && !declares(filters::contract::consistent))
    GTEST_SKIP() << "not promised";
  std::mt19937 random(1);
  const auto record = decay(1, 3000, 1e-3, 0.0, random);
  const auto filter = oscillator(1, 1e-3, 1e-9);
  const auto initial = start({0.012, 0.0, 0.9 * stiffness, 1.2 * damping}, {1e-6, 1e-4, 1e4, 10.0});
  const auto result = run(*filter, initial, record);
  ASSERT_FALSE(result.failure) << result.failure->reason;
  EXPECT_NEAR(result.last.mean[2] / stiffness, 1.0, 1e-6);
  EXPECT_NEAR(result.last.mean[3] / damping, 1.0, 1e-6);
}

TEST_P(EveryFilter, ErrsAsMuchAsItSays) {
  // Oracle: the mean normalised estimation error squared over N runs is chi-square(2 N)/N; its 99.9 % band by
  // Wilson and Hilferty. The truth is drawn from the prior, as the filter is told.
  if (!declares(filters::contract::consistent)) GTEST_SKIP() << "not promised";
  constexpr int runs = 300;
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  double sum = 0.0;
  for (int i = 0; i < runs; ++i) {
    const double noise = 1e-4;
    const auto record = decay(1, 1500, 2e-3, noise, random);
    const auto filter = oscillator(1, 2e-3, noise);
    const Eigen::Vector4d truth(0.012, 0.0, stiffness, damping), deviation(2e-4, 2e-3, 15.0, 1.0);
    const Eigen::Vector4d mean =
        truth + deviation.cwiseProduct(Eigen::Vector4d::NullaryExpr([&] { return normal(random); }));
    const auto result =
        run(*filter, start(mean, deviation.cwiseAbs2()), record, filters::Keep::all_estimates);
    ASSERT_FALSE(result.failure);
    // K and C do not move, so the last estimate about them has an error of two degrees of freedom; where they
    // are known, so has the motion at the first sample.
    const Index first = linear_only() ? 0 : 2;
    const Gaussian& estimate = linear_only() ? result.filtered.front() : result.last;
    const Eigen::Vector2d error = estimate.mean.segment<2>(first) - truth.segment<2>(first);
    sum += error.dot(estimate.marginal(first, 2).inverse() * error);
  }
  const double freedoms = 2.0 * runs, spread = 3.29 * std::sqrt(2.0 / (9.0 * freedoms));
  const double centre = 1.0 - 2.0 / (9.0 * freedoms);
  EXPECT_GT(sum / runs, 2.0 * std::pow(centre - spread, 3));
  EXPECT_LT(sum / runs, 2.0 * std::pow(centre + spread, 3));
}

TEST_P(EveryFilter, ChangesNothingWhenUnitsChange) {
  // Oracle: the run in metres; micrometres must change nothing but the units.
  std::mt19937 random(5);
  auto record = decay(1, 1000, 1e-3, 1e-4, random);
  const Eigen::Vector4d mean(0.012, 0.0, 500.0, 9.0), deviation(1e-3, 1e-2, 30.0, 3.0);
  const auto in_metres = run(*oscillator(1, 1e-3, 1e-4), start(mean, deviation.cwiseAbs2()), record);
  record.outputs *= 1e6;
  const Eigen::Vector4d scale(1e6, 1e6, 1.0, 1.0);
  const auto in_micrometres =
      run(*oscillator(1, 1e-3, 1e2),
          start(scale.cwiseProduct(mean), scale.cwiseProduct(deviation).cwiseAbs2()), record);
  const VectorXd units = scale.head(in_metres.last.mean.size());
  const VectorXd expected = units.cwiseProduct(in_metres.last.mean);
  const VectorXd spread = units.cwiseProduct(in_metres.last.deviations());
  EXPECT_LT((in_micrometres.last.mean - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((in_micrometres.last.deviations() - spread).cwiseQuotient(spread).cwiseAbs().maxCoeff(), 1e-8);
}

TEST_P(EveryFilter, SurvivesAStartThatIsOneSampleLateOrSaysSo) {
  // Oracle: the truth. The record starts one sample after the motion that the estimate is about, and the
  // prior is wide. A filter may be misled by it, but not in silence: it fails, or its innovations are too
  // large.
  if (linear_only()) GTEST_SKIP() << "the model is not linear";
  std::mt19937 random(41);
  auto record = decay(2, 2001, 1e-3, 1e-4, random);
  record.outputs = record.outputs.rightCols(2000).eval();
  record.time = record.time.head(2000).eval();
  const auto initial = start({0.012, 0.0, 300.0, 2.0}, {1.0, 1.0, 1e5, 1e5});
  const auto result = run(*oscillator(2, 1e-3, 1e-4), initial, record);
  const bool found = std::abs(result.last.mean[2] / stiffness - 1.0) < 0.02 &&
                     std::abs(result.last.mean[3] / damping - 1.0) < 0.2;
  const bool reported = result.failure || !innovation_consistency(result).size_is_right();
  EXPECT_TRUE(found || reported) << "K " << result.last.mean[2] << ", C " << result.last.mean[3];
}

}  // namespace beamid::test::identification
