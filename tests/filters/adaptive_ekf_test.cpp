// Noise from the innovations, when the filter was told another.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "beamid/testing/known_oscillator.hpp"
#include "beamid/testing/linear_model.hpp"
#include "filters/diagnostics.hpp"
#include "filters/filter_run.hpp"

namespace beamid::test::adaptive_ekf_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::filter_registry;

const Eigen::Vector4d mean(0.0121, 0.001, 500.0, 8.5), variance(4e-8, 4e-6, 225.0, 1.0);

// Innovations of the last samples over the deviations that the filter told for them: 1 when right.
double told_ratio(double told, double real, const filters::Options& options, const char* name) {
  std::mt19937 random(6);
  const auto record = decay(1, 2000, 2e-3, real, random);
  const auto filter = filter_registry().make(name, options, joint_model(1, 2e-3, told));
  const auto result = run(*filter, {mean, MatrixXd(variance.asDiagonal())}, record);
  EXPECT_FALSE(result.failure);
  return std::sqrt(result.normalised_squares.tail(1000).mean());
}

TEST(AdaptiveEkf, FindsTheOutputNoiseHoweverWrongItWasTold) {
  // Oracle: the noise of the record. A thousand readings tell a deviation to 2.2 %.
  for (const double factor : {0.01, 0.1, 1.0, 10.0, 100.0})
    EXPECT_NEAR(told_ratio(1e-4 * factor, 1e-4, {}, "adaptive_ekf"), 1.0, 0.07) << factor;
  EXPECT_NEAR(told_ratio(1e-3, 1e-4, {}, "ekf"), 0.1, 0.01);  // what it would be without
}

TEST(AdaptiveEkf, FindsTheProcessNoiseOfAWalk) {
  // Oracle: a random walk of q = 0.01 read with r = 1, told q = 1e-4: the innovations' size.
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  LinearModel model;
  model.a = model.c = model.r = MatrixXd::Ones(1, 1);
  model.q = MatrixXd::Constant(1, 1, 1e-4);
  filters::Measurements record{VectorXd::LinSpaced(4000, 0, 3999), MatrixXd(1, 4000), {}};
  double x = 0.0;
  for (Index k = 0; k < 4000; ++k) record.outputs(0, k) = (x += 0.1 * normal(random)) + normal(random);
  const auto size = [&](const char* name, const filters::Options& options) {
    const auto filter = filter_registry().make(name, options, std::make_unique<LinearModel>(model));
    return run(*filter, {VectorXd::Zero(1), MatrixXd::Ones(1, 1)}, record)
        .normalised_squares.tail(2000)
        .mean();
  };
  EXPECT_NEAR(size("adaptive_ekf", {{"adapt", std::string("process")}}), 1.0, 0.1);
  EXPECT_GT(size("ekf", {}), 1.3);
}

TEST(AdaptiveEkf, KeepsItsNoisePositiveWhereOutputsComeAndGo) {
  // Two outputs of correlated noise, one of them read every fifth time only.
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  LinearModel model;
  model.a = 0.9 * MatrixXd::Identity(2, 2);
  model.c = MatrixXd::Identity(2, 2);
  model.q = MatrixXd::Identity(2, 2);
  model.r.resize(2, 2);
  model.r << 1.0, 0.9, 0.9, 1.0;
  const auto filter =
      filter_registry().make("adaptive_ekf", {{"window", 20.0}}, std::make_unique<LinearModel>(model));
  filter->reset({VectorXd::Zero(2), MatrixXd::Identity(2, 2)});
  for (int k = 0; k < 2000; ++k) {
    filter->predict({});
    Eigen::Vector2d y(3.0 * normal(random), normal(random));
    if (k % 5 != 0) y[1] = std::numeric_limits<double>::quiet_NaN();
    const auto& correction = filter->correct(y, {});
    ASSERT_GT(correction.innovation_covariance.determinant(), 0.0);
    ASSERT_TRUE(filter->estimate().mean.allFinite());
  }
}

TEST(AdaptiveEkf, SaysWhatNoiseItFound) {
  std::mt19937 random(6);
  const auto record = decay(1, 2000, 2e-3, 1e-4, random);
  const auto filter = filter_registry().make("adaptive_ekf", {}, joint_model(1, 2e-3, 1e-3));
  const auto result = run(*filter, {mean, MatrixXd(variance.asDiagonal())}, record);
  ASSERT_EQ(result.remarks.size(), 1u);
  EXPECT_NE(result.remarks[0].find("output noise: x "), std::string::npos);
  EXPECT_NE(result.remarks[0].find("e-0"), std::string::npos) << result.remarks[0];
  EXPECT_NE(result.remarks[0].find(" m"), std::string::npos);
}

TEST(AdaptiveEkf, RefusesOptionsThatMeanNothing) {
  const auto make = [](const filters::Options& options) {
    return filter_registry().make("adaptive_ekf", options, joint_model(1, 1e-3, 1.0));
  };
  EXPECT_THROW(make({{"adapt", std::string("R")}}), std::invalid_argument);
  EXPECT_THROW(make({{"window", 1.0}}), std::invalid_argument);
  EXPECT_THROW(make({{"window", std::nan("")}}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::test::adaptive_ekf_test
