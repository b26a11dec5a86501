// Covariances remain symmetric and positive, at every step.
#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>
#include <memory>
#include <random>

#include "beamid/testing/every_filter.hpp"
#include "beamid/testing/linear_model.hpp"

namespace beamid::test::covariance {

using Eigen::MatrixXd, Eigen::VectorXd;

inline void expect_symmetric_and_positive(const filters::Gaussian& estimate) {
  const MatrixXd covariance = estimate.marginal(0, estimate.mean.size());
  ASSERT_EQ((covariance - covariance.transpose()).norm(), 0.0);
  const VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  ASSERT_TRUE(scale.allFinite());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> correlation(scale.asDiagonal() * covariance *
                                                            scale.asDiagonal());
  ASSERT_GT(correlation.eigenvalues()[0], 0.0);
}

TEST_P(EveryFilter, KeepsItsCovarianceSymmetricAndPositive) {
  // The paper's wide prior (variance 1e5 on K and C) against a noise of 1e-5: ten decades, every step
  // inspected.
  std::mt19937 random(3);
  const auto record = decay(2, 2000, 1e-3, 0.0, random);
  const auto initial = start({0.012, 0.0, 300.0, 2.0}, {1.0, 1.0, 1e5, 1e5});
  const auto result =
      run(*oscillator(2, 1e-3, std::sqrt(1e-5)), initial, record, filters::Keep::all_estimates);
  ASSERT_FALSE(result.failure) << result.failure->reason;
  for (const auto& estimate : result.predicted) expect_symmetric_and_positive(estimate);
  for (const auto& estimate : result.filtered) expect_symmetric_and_positive(estimate);
}

TEST_P(EveryFilter, TakesStatesThatAreKnownExactly) {
  // A variance of zero stays zero where nothing moves it, and nothing fails.
  if (linear_only()) GTEST_SKIP() << "the model is not linear";
  std::mt19937 random(3);
  const auto record = decay(1, 300, 1e-3, 1e-4, random);
  const auto initial = start({0.012, 0.0, 500.0, damping}, {1e-6, 1e-4, 1e2, 0.0});
  const auto result = run(*oscillator(1, 1e-3, 1e-4), initial, record);
  ASSERT_FALSE(result.failure) << result.failure->reason;
  EXPECT_NEAR(result.last.mean[3], damping, 1e-9);
  EXPECT_NEAR(result.last.deviations()[3], 0.0, 1e-9);
}

TEST_P(EveryFilter, FollowsAMotionUntilNothingIsLeftOfIt) {
  // What dies out leaves the numbers of the machine, its variance at half the time. Oracle: of a constant
  // seen beside it, sure to 1 and read 5000 times with R = 1, the variance is 1 / 5001.
  if (!declares(filters::contract::exact_on_linear_gaussian)) GTEST_SKIP() << "not exact";
  const Eigen::Index samples = 5000;
  auto model = std::make_unique<LinearModel>();
  model->a = VectorXd({{1.0, 0.0, 0.0}}).asDiagonal();
  model->a.bottomRightCorner(2, 2) << 0.6, 0.6, -0.6, 0.6;  // of modulus 0.85
  model->c = MatrixXd::Zero(2, 3);
  model->c(0, 0) = model->c(1, 1) = 1.0;
  model->q = MatrixXd::Zero(3, 3);
  model->r = MatrixXd::Identity(2, 2);
  const auto filter = filters::filter_registry().make(GetParam(), {}, std::move(model));
  const filters::Measurements record{
      VectorXd::LinSpaced(samples, 0.0, static_cast<double>(samples - 1)), MatrixXd::Zero(2, samples), {}};
  const auto result = run(*filter, {VectorXd::Zero(3), MatrixXd::Identity(3, 3)}, record);
  ASSERT_FALSE(result.failure) << result.failure->reason << " at step " << result.failure->step;
  EXPECT_NEAR(std::pow(result.last.deviations()[0], 2) * (samples + 1), 1.0, 1e-9);
  EXPECT_LT(result.last.deviations()[1], 1e-100);
}

}  // namespace beamid::test::covariance
