// Readings that are missing, marked by NaN.
#pragma once

#include <limits>
#include <memory>
#include <random>

#include "beamid/testing/every_filter.hpp"
#include "beamid/testing/kalman_recursion.hpp"

namespace beamid::test::missing_readings {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::Gaussian;

inline constexpr double missing = std::numeric_limits<double>::quiet_NaN();

TEST_P(EveryFilter, EqualsTheKalmanFilterOfWhatWasMeasured) {
  // Oracle: the information form with the missing rows removed. Single outputs and whole samples are missing.
  if (!declares(filters::contract::exact_on_linear_gaussian)) GTEST_SKIP() << "not promised";
  std::mt19937 random(29);
  const Index n = 4, p = 3;
  const LinearModel model = random_model(n, p, random);
  MatrixXd readings = random_readings(p, 60, random);
  for (Index k = 0; k < readings.cols(); ++k)
    for (Index i = 0; i < p; ++i)
      if (random() % 3 == 0 || k % 10 == 4) readings(i, k) = missing;
  const Gaussian initial{VectorXd::Zero(n), MatrixXd::Identity(n, n)};
  const auto filter = make(std::make_unique<LinearModel>(model));
  filter->reset(initial);
  KalmanRecursion expected{model, initial.mean, initial.covariance};
  double log_likelihood = 0.0;
  for (Index k = 0; k < readings.cols(); ++k) {
    filter->predict({});
    expected.predict();
    log_likelihood += filter->correct(readings.col(k), {}).log_likelihood;
    expected.correct(readings.col(k));
  }
  const Gaussian& found = filter->estimate();
  EXPECT_LT((found.mean - expected.mean).norm(), 1e-10 * (1 + expected.mean.norm()));
  EXPECT_LT((found.marginal(0, n) - expected.covariance).norm(), 1e-10 * expected.covariance.norm());
  EXPECT_NEAR(log_likelihood / expected.log_likelihood, 1.0, 1e-10);
}

TEST_P(EveryFilter, LearnsNothingFromNothing) {
  // Oracle: the estimate before.
  const auto filter = oscillator(2, 1e-3, 1e-4);
  filter->reset(start({0.012, 0.0, 500.0, 9.0}, {1e-6, 1e-4, 1e2, 1.0}));
  for (int k = 0; k < 3; ++k) {
    filter->predict({});
    const Gaussian before = filter->estimate();
    const auto& correction = filter->correct(VectorXd::Constant(2, missing), {});
    EXPECT_EQ(correction.innovation.size(), 0);
    EXPECT_EQ(correction.log_likelihood, 0.0);
    EXPECT_EQ(filter->estimate().mean, before.mean);
    EXPECT_EQ(filter->estimate().deviations(), before.deviations());
    filter->correct(Eigen::Vector2d(0.0119, missing), {});
    EXPECT_LT(filter->estimate().deviations()[0], before.deviations()[0]);
  }
}

TEST_P(EveryFilter, TakesAnOutputThatIsNeverMeasuredAsAbsent) {
  // Oracle: the same filter on the model without that output.
  std::mt19937 random(31);
  const auto record = decay(1, 300, 2e-3, 1e-4, random);
  const auto one = oscillator(1, 2e-3, 1e-4), two = oscillator(2, 2e-3, 1e-4);
  const Gaussian initial = start({0.012, 0.0, 500.0, 9.0}, {1e-6, 1e-4, 1e2, 1.0});
  one->reset(initial);
  two->reset(initial);
  for (Index k = 0; k < record.time.size(); ++k) {
    if (k > 0) one->predict({});
    if (k > 0) two->predict({});
    one->correct(record.outputs.col(k), {});
    two->correct(Eigen::Vector2d(record.outputs(0, k), missing), {});
  }
  const VectorXd deviation = one->estimate().deviations();
  EXPECT_LT((two->estimate().mean - one->estimate().mean).cwiseQuotient(deviation).norm(), 1e-9);
  EXPECT_LT((two->estimate().deviations() - deviation).cwiseQuotient(deviation).norm(), 1e-9);
}

TEST_P(EveryFilter, CarriesOnOverGaps) {
  // Oracle: the truth, within five deviations. A fifth of the readings is missing, and one stretch of a
  // tenth.
  std::mt19937 random(37);
  auto record = decay(2, 1000, 2e-3, 1e-4, random);
  for (Index k = 0; k < 1000; ++k)
    for (Index i = 0; i < 2; ++i)
      if (random() % 5 == 0 || (k >= 400 && k < 500)) record.outputs(i, k) = missing;
  const auto filter = oscillator(2, 2e-3, 1e-4);
  filter->reset(start({0.012, 0.0, 500.0, 9.0}, {1e-6, 1e-4, 4e2, 4.0}));
  for (Index k = 0; k < 1000; ++k) {
    if (k > 0) filter->predict({});
    filter->correct(record.outputs.col(k), {});
  }
  if (linear_only()) return;
  const Gaussian& found = filter->estimate();
  EXPECT_NEAR(found.mean[2], stiffness, 5.0 * found.deviations()[2]);
  EXPECT_NEAR(found.mean[3], damping, 5.0 * found.deviations()[3]);
}

}  // namespace beamid::test::missing_readings
