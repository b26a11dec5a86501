// The square-root filters: what carrying a root instead of a covariance is good for.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "beamid/testing/linear_model.hpp"
#include "beamid/testing/oscillator.hpp"
#include "filters/filter_run.hpp"

namespace beamid::srukf_test {
namespace {

using Eigen::MatrixXd, Eigen::Vector4d, Eigen::VectorXd;
using filters::filter_registry;

class SquareRoot : public testing::TestWithParam<const char*> {};

TEST_P(SquareRoot, KeepsEveryDigitOfAMeasurementAfterAPriorOfTenToThe24) {
  // Oracle: P11 = P0 R / (P0 + R), which is R to 24 digits. A gain in doubles is 1 to rounding and leaves
  // anything from nothing to 1e8 behind.
  for (const double wide : {1e24, 3.7e24, 1e20}) {
    const auto filter =
        filter_registry().make(GetParam(), {}, std::make_unique<test::LinearModel>(test::two_state_model()));
    filter->reset({VectorXd::Zero(2), wide * MatrixXd::Identity(2, 2)});
    filter->correct(VectorXd::Constant(1, 3.0), {});
    EXPECT_NEAR(filter->estimate().covariance(0, 0) / 0.04, 1.0, 1e-12) << wide;
    EXPECT_NEAR(filter->estimate().covariance(1, 1) / wide, 1.0, 1e-12) << wide;
    EXPECT_NEAR(filter->estimate().mean[0], 3.0, 1e-12);
  }
}

TEST_P(SquareRoot, GoesOnFromTheFactorOfItsOwnEstimate) {
  // Stopped and started again from the estimate, as from one that never stopped.
  const auto filter =
      filter_registry().make(GetParam(), {}, std::make_unique<test::LinearModel>(test::two_state_model()));
  const auto other =
      filter_registry().make(GetParam(), {}, std::make_unique<test::LinearModel>(test::two_state_model()));
  filter->reset({VectorXd::Zero(2), MatrixXd::Identity(2, 2)});
  for (int k = 0; k < 20; ++k) {
    filter->correct(VectorXd::Constant(1, std::sin(0.3 * k)), {});
    filter->predict({});
    if (k == 9) other->reset(filter->estimate());
    if (k < 10) continue;
    other->correct(VectorXd::Constant(1, std::sin(0.3 * k)), {});
    other->predict({});
  }
  EXPECT_LT((filter->estimate().mean - other->estimate().mean).norm(), 1e-14);
  EXPECT_LT((filter->estimate().covariance - other->estimate().covariance).norm(), 1e-14);
}

TEST_P(SquareRoot, IsTheFilterOnTheCovarianceItself) {
  // Oracle: ukf and ckf, which share the points but not the arithmetic, on a strongly nonlinear start.
  const auto model = [] {
    return filters::discretise(std::make_shared<test::Oscillator>(3.0, 2), 5e-3, "exponential",
                               {1e-9 * MatrixXd::Identity(4, 4), 1e-6 * MatrixXd::Identity(2, 2)});
  };
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  filters::Measurements record{VectorXd::LinSpaced(200, 0.0, 0.995), MatrixXd(2, 200), {}};
  Vector4d z(0.012, 0.0, 515.8, 7.867);
  VectorXd next;
  for (Eigen::Index k = 0; k < 200; ++k) {
    record.outputs.col(k) << z[0] + 1e-3 * normal(random), z[1] + 1e-3 * normal(random);
    model()->transition(z, {}, next);
    z = next;
  }
  const Vector4d mean(0.012, 0.0, 350.0, 20.0), variance(1e-6, 1e-4, 2.5e4, 100.0);
  const auto found =
      run(*filter_registry().make(GetParam(), {}, model()), {mean, variance.asDiagonal()}, record);
  const char* plain = std::string(GetParam()) == "srukf" ? "ukf" : "ckf";
  const auto expected =
      run(*filter_registry().make(plain, {}, model()), {mean, variance.asDiagonal()}, record);
  ASSERT_FALSE(found.failure);
  const VectorXd scale = expected.last.deviations().cwiseInverse();
  EXPECT_LT(scale.cwiseProduct(found.last.mean - expected.last.mean).norm(), 1e-9);
  const MatrixXd error = found.last.covariance - expected.last.covariance;
  EXPECT_LT((scale.asDiagonal() * error * scale.asDiagonal()).norm(), 1e-9);
  EXPECT_NEAR(found.log_likelihood / expected.log_likelihood, 1.0, 1e-10);
}

TEST_P(SquareRoot, TakesInASensorWithoutNoise) {
  // Oracle: y = x without noise leaves no variance of x, and x = y.
  auto model = test::two_state_model();
  model.r.setZero();
  const auto filter = filter_registry().make(GetParam(), {}, std::make_unique<test::LinearModel>(model));
  MatrixXd prior(2, 2);
  prior << 2.0, 0.5, 0.5, 1.0;
  filter->reset({VectorXd::Zero(2), prior});
  filter->correct(VectorXd::Constant(1, 1.5), {});
  EXPECT_NEAR(filter->estimate().mean[0], 1.5, 1e-15);
  EXPECT_NEAR(filter->estimate().mean[1], 1.5 * 0.25, 1e-15);
  EXPECT_NEAR(filter->estimate().covariance(0, 0), 0.0, 1e-30);
  EXPECT_NEAR(filter->estimate().covariance(1, 1), 1.0 - 0.125, 1e-15);
}

TEST_P(SquareRoot, SeesOnlyWhatWasMeasuredAndTheNoiseOfTheStep) {
  // Oracle: ekf on the same linear model, outputs missing in turn and R another one from step to step.
  auto model = test::two_state_model();
  model.c.setIdentity(2, 2);
  model.r = 0.04 * MatrixXd::Identity(2, 2);
  const auto filter = filter_registry().make(GetParam(), {}, std::make_unique<test::LinearModel>(model));
  const auto exact = filter_registry().make("ekf", {}, std::make_unique<test::LinearModel>(model));
  for (auto* each : {filter.get(), exact.get()}) {
    each->reset({VectorXd::Zero(2), MatrixXd::Identity(2, 2)});
    for (int k = 0; k < 30; ++k) {
      VectorXd y(2);
      y << (k % 3 == 0 ? std::nan("") : std::sin(0.2 * k)), (k % 4 == 1 ? std::nan("") : 0.1 * k);
      each->model().set_output_noise(MatrixXd((0.01 + 0.01 * (k % 5)) * MatrixXd::Identity(2, 2)));
      each->model().set_process_noise(MatrixXd(1e-3 * (1 + k % 2) * MatrixXd::Identity(2, 2)));
      each->correct(y, {});
      each->predict({});
    }
  }
  EXPECT_LT((filter->estimate().mean - exact->estimate().mean).norm(), 1e-13);
  EXPECT_LT((filter->estimate().covariance - exact->estimate().covariance).norm(), 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Both, SquareRoot, testing::Values("srukf", "srckf"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(Srukf, RefusesTheSpreadsThatUkfRefuses) {
  const auto make = [](const filters::Options& options) {
    return filter_registry().make("srukf", options,
                                  std::make_unique<test::LinearModel>(test::two_state_model()));
  };
  EXPECT_NO_THROW(make({{"alpha", 1e-3}}));
  EXPECT_THROW(make({{"alpha", 0.0}}), std::invalid_argument);
  EXPECT_THROW(make({{"alpha", 1e-6}}), std::invalid_argument);
  EXPECT_THROW(make({{"alpha", 2.0}}), std::invalid_argument);  // beta = 2 < alpha^2
  EXPECT_THROW(make({{"kappa", -2.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::srukf_test
