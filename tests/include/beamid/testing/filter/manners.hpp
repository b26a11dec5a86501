// What every filter refuses and reports.
#pragma once

#include <limits>
#include <random>
#include <stdexcept>

#include "beamid/testing/every_filter.hpp"
#include "beamid/testing/named.hpp"

namespace beamid::test::manners {

using Eigen::MatrixXd, Eigen::VectorXd;
using filters::filter_registry;

TEST_P(EveryFilter, ReportsWhereItFailed) {
  std::mt19937 random(1);
  auto record = decay(1, 100, 1e-3, 0.0, random);
  record.outputs(0, 60) = std::numeric_limits<double>::infinity();
  const auto initial = start({0.012, 0.0, 500.0, 9.0}, {1e-6, 1e-4, 1e2, 1.0});
  const auto result = run(*oscillator(1, 1e-3, 1e-4), initial, record, filters::Keep::all_estimates);
  ASSERT_TRUE(result.failure);
  EXPECT_EQ(result.failure->step, 60);
  EXPECT_NEAR(result.failure->time, 0.060, 1e-12);
  EXPECT_FALSE(result.failure->reason.empty());
  EXPECT_EQ(result.filtered.size(), 60u);  // the partial run is kept
}

TEST_P(EveryFilter, RefusesEstimatesThatDoNotFit) {
  const auto filter = make(joint_model(1, 1e-3, 1e-4));
  EXPECT_THROW(filter->reset({VectorXd::Zero(3), MatrixXd::Identity(3, 3)}), std::invalid_argument);
  MatrixXd lopsided = MatrixXd::Identity(4, 4);
  lopsided(0, 1) = 0.5;
  EXPECT_THROW(filter->reset({VectorXd::Zero(4), lopsided}), std::invalid_argument);
  EXPECT_THROW(filter->reset({VectorXd::Zero(4), -MatrixXd::Identity(4, 4)}), std::invalid_argument);
}

TEST_P(EveryFilter, RejectsUnknownOptions) {
  EXPECT_THROW(filter_registry().completed(GetParam(), {{"no_such_option", 1.0}}), std::invalid_argument);
}

TEST_P(EveryFilter, NamesItsSourceAndDescribesItsOptions) {
  expect_described(filter_registry().find(GetParam()));
  EXPECT_FALSE(filter_registry().find(GetParam()).source.empty());
}

TEST_P(EveryFilter, RefusesNonlinearModelsIfItIsForLinearOnes) {
  if (!linear_only()) GTEST_SKIP() << "takes every model";
  const auto filter = make(joint_model(1, 1e-3, 1e-4));
  filter->reset({Eigen::Vector4d(0.012, 0.0, 500.0, 9.0), MatrixXd::Identity(4, 4)});
  EXPECT_THROW(filter->predict({}), std::invalid_argument);
}

}  // namespace beamid::test::manners
