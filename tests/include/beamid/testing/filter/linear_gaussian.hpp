// On linear models with Gaussian noise there is one right answer.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <random>

#include "beamid/testing/every_filter.hpp"
#include "beamid/testing/kalman_recursion.hpp"

namespace beamid::test::linear_gaussian {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::Gaussian;

TEST_P(EveryFilter, ReproducesThePublishedCase) {
  // Oracle: the same recursion in exact rational arithmetic. (A published float result of this
  // case, 6.71906243764755 and 1.52810614201467, agrees to nine digits only.)
  if (!declares(filters::contract::exact_on_linear_gaussian)) GTEST_SKIP() << "not promised";
  LinearModel model;
  model.a.resize(2, 2), model.c.resize(1, 2);
  model.a << 1, 1, 0, 1;
  model.c << 0.5, -0.3;
  model.q = 2.0 * MatrixXd::Identity(2, 2);
  model.r = MatrixXd::Constant(1, 1, 0.5);
  const auto filter = make(std::make_unique<LinearModel>(model));
  Gaussian initial{VectorXd::Ones(2), MatrixXd(2, 2)};
  initial.covariance << 1, 0.1, 0.1, 1;
  filters::Measurements record{VectorXd::LinSpaced(3, 0, 2), MatrixXd(1, 3), {}};
  record.outputs << 1, 2, 3;
  const auto result =
      run(*filter, initial, record, filters::Keep::all_estimates, filters::Start::one_interval_before);
  ASSERT_FALSE(result.failure);
  const MatrixXd covariance = result.last.marginal(0, 2);
  EXPECT_NEAR(result.last.mean[0], 6.71906243590896, 1e-13);
  EXPECT_NEAR(result.last.mean[1], 1.5281061413773416, 1e-13);
  EXPECT_NEAR(covariance(0, 0), 4.390246585980715, 1e-13);
  EXPECT_NEAR(covariance(0, 1), 3.90194406652603, 1e-13);
  EXPECT_NEAR(covariance(1, 1), 5.409573044716606, 1e-13);
}

TEST_P(EveryFilter, EqualsTheKalmanFilterOnLinearModels) {
  // Oracle: the information form, another algorithm for the same posterior.
  if (!declares(filters::contract::exact_on_linear_gaussian)) GTEST_SKIP() << "not promised";
  std::mt19937 random(7);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Index n = 1 + repeat % 5, p = 1 + repeat % 3, samples = 30;
    const LinearModel model = random_model(n, p, random);
    const filters::Measurements record{VectorXd::LinSpaced(samples, 0, static_cast<double>(samples - 1)),
                                       random_readings(p, samples, random),
                                       {}};
    const Gaussian initial{VectorXd::Zero(n), MatrixXd::Identity(n, n)};
    const auto result = run(*make(std::make_unique<LinearModel>(model)), initial, record);
    KalmanRecursion expected{model, initial.mean, initial.covariance};
    for (Index k = 0; k < samples; ++k) {
      if (k > 0) expected.predict();
      expected.correct(record.outputs.col(k));
    }
    EXPECT_LT((result.last.mean - expected.mean).norm(), 1e-10 * (1 + expected.mean.norm()));
    EXPECT_LT((result.last.marginal(0, n) - expected.covariance).norm(), 1e-10 * expected.covariance.norm());
    EXPECT_NEAR(result.log_likelihood / expected.log_likelihood, 1.0, 1e-10);
  }
}

TEST_P(EveryFilter, ApproachesTheKalmanFilterAsItsSampleGrows) {
  // Oracle: the information form. A mean of N samples is off by 1 / sqrt(N) deviations, and resampling about
  // doubles that; a log-likelihood by as much per root of a reading. Four thousand samples, five standard
  // errors.
  if (!declares(filters::contract::sampled_on_linear_gaussian)) GTEST_SKIP() << "not promised";
  constexpr double count = 4000.0;
  filters::Options options;
  for (const auto& option : filters::filter_registry().find(GetParam()).options)
    if (option.name == "members" || option.name == "particles") options.set(option.name, count);
  ASSERT_FALSE(options.values().empty()) << "a sample grows by option 'members' or 'particles'";
  std::mt19937 random(17);
  for (int repeat = 0; repeat < 4; ++repeat) {
    const Index n = 1 + repeat % 2, p = 1, samples = 20;
    const LinearModel model = random_model(n, p, random);
    const filters::Measurements record{VectorXd::LinSpaced(samples, 0, static_cast<double>(samples - 1)),
                                       random_readings(p, samples, random),
                                       {}};
    const Gaussian initial{VectorXd::Zero(n), MatrixXd::Identity(n, n)};
    const auto result = run(*make(std::make_unique<LinearModel>(model), options), initial, record);
    KalmanRecursion expected{model, initial.mean, initial.covariance};
    for (Index k = 0; k < samples; ++k) {
      if (k > 0) expected.predict();
      expected.correct(record.outputs.col(k));
    }
    const VectorXd deviation = expected.covariance.diagonal().cwiseSqrt();
    const double five = 5.0 / std::sqrt(count);
    const VectorXd error = (result.last.mean - expected.mean).cwiseQuotient(deviation);
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 2.0 * five);
    EXPECT_LT((result.last.deviations().cwiseQuotient(deviation).array() - 1.0).abs().maxCoeff(), 2.0 * five);
    EXPECT_NEAR(result.log_likelihood, expected.log_likelihood,
                five * std::sqrt(static_cast<double>(samples)));
  }
}

TEST_P(EveryFilter, GoesOnFromItsEstimateAsIfNeverInterrupted) {
  // Oracle: the run without interruption.
  if (!declares(filters::contract::exact_on_linear_gaussian)) GTEST_SKIP() << "not promised";
  std::mt19937 random(23);
  const LinearModel model = random_model(3, 2, random);
  const MatrixXd readings = random_readings(2, 40, random);
  const Gaussian initial{VectorXd::Zero(3), MatrixXd::Identity(3, 3)};
  const auto whole = make(std::make_unique<LinearModel>(model));
  auto part = make(std::make_unique<LinearModel>(model));
  whole->reset(initial);
  part->reset(initial);
  for (Index k = 0; k < readings.cols(); ++k) {
    if (k == 17) {  // another filter goes on from what this one has found
      const Gaussian estimate = part->estimate();
      part = make(std::make_unique<LinearModel>(model));
      part->reset(estimate);
    }
    for (const auto& filter : {whole.get(), part.get()}) {
      filter->predict({});
      filter->correct(readings.col(k), {});
    }
  }
  const Gaussian expected = whole->estimate(), found = part->estimate();
  EXPECT_LT((found.mean - expected.mean).norm(), 1e-12 * (1.0 + expected.mean.norm()));
  EXPECT_LT((found.marginal(0, 3) - expected.marginal(0, 3)).norm(), 1e-12 * expected.marginal(0, 3).norm());
}

}  // namespace beamid::test::linear_gaussian
