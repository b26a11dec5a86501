// The Kalman filter of linear models: its square roots, and what it takes for linear.
#include <gtest/gtest.h>

#include <cmath>

#include "beamid/testing/known_oscillator.hpp"
#include "beamid/testing/linear_model.hpp"
#include "filters/filter_run.hpp"
#include "tests/filters/classic/function_model.hpp"

namespace beamid::test::kf_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::filter_registry;

std::unique_ptr<filters::Filter> kf(std::unique_ptr<filters::DiscreteModel> model) {
  return filter_registry().make("kf", {}, std::move(model));
}

TEST(Kf, KeepsItsDigitsUnderAnInfinitelyWidePrior) {
  // Oracle: a prior of variance 1e24 adds nothing to a reading of variance 0.04.
  LinearModel model;
  model.a = model.c = MatrixXd::Identity(2, 2);
  model.r = 0.04 * MatrixXd::Identity(2, 2);
  const auto filter = kf(std::make_unique<LinearModel>(model));
  filter->reset({VectorXd::Zero(2), 1e24 * MatrixXd::Identity(2, 2)});
  filter->correct(Eigen::Vector2d(1.0, 2.0), {});
  EXPECT_NEAR(filter->estimate().covariance(0, 0), 0.04, 1e-15);
  EXPECT_NEAR(filter->estimate().covariance(1, 1), 0.04, 1e-15);
  EXPECT_NEAR(filter->estimate().covariance(0, 1), 0.0, 1e-15);
  EXPECT_NEAR(filter->estimate().mean[0], 1.0, 1e-15);
}

TEST(Kf, KeepsDigitsThatJosephsFormRoundsAndTheShortFormLoses) {
  // Oracle: P0 R / (P0 + R), which is R to 18 digits and more. docs/theory/filters.md: Joseph's form
  // (1 - G)^2 P0 + G^2 R errs by the square of the gain's rounding, 1e-32 P0; P0 - G S G^T is a difference of
  // two numbers of the size of P0.
  LinearModel model;
  model.a = model.c = MatrixXd::Identity(2, 2);
  model.r = 0.04 * MatrixXd::Identity(2, 2);
  const auto left = [&](const char* name, double wide) {
    const auto filter = filter_registry().make(name, {}, std::make_unique<LinearModel>(model));
    filter->reset({VectorXd::Zero(2), wide * MatrixXd::Identity(2, 2)});
    filter->correct(Eigen::Vector2d(1.0, 2.0), {});
    return filter->estimate().covariance(0, 0);
  };
  for (const double wide : {1e20, 1e24, 3.7e24}) {
    EXPECT_NEAR(left("kf", wide), 0.04, 1e-15) << wide;
    EXPECT_NEAR(left("ekf", wide), 0.04, 1.3e-32 * wide + 1e-15) << wide;
    const double gain = wide / (wide + 0.04), short_form = wide - gain * (wide + 0.04) * gain;
    EXPECT_GT(std::abs(short_form - 0.04), 0.039) << wide;
  }
}

TEST(Kf, FollowsAModelThroughChangesOfItsIntervalAndOutputs) {
  // Oracle: the extended filter's own algorithm.
  std::mt19937 random(2);
  const auto record = decay(2, 60, 1e-3, 1e-4, random);
  const auto extended = filter_registry().make("ekf", {}, std::make_unique<KnownOscillator>(2, 1e-3, 1e-4));
  const auto filter = kf(std::make_unique<KnownOscillator>(2, 1e-3, 1e-4));
  for (const auto& each : {extended.get(), filter.get()}) {
    each->reset({Eigen::Vector2d(0.012, 0.0), 1e-4 * MatrixXd::Identity(2, 2)});
    for (Index k = 0; k < 60; ++k) {
      each->model().set_interval(k % 7 == 3 ? 5e-3 : 1e-3);
      each->predict({});
      VectorXd y = record.outputs.col(k);
      if (k % 3 == 0) y[k % 2] = std::nan("");
      each->correct(y, {});
    }
  }
  EXPECT_LT((filter->estimate().mean - extended->estimate().mean).norm(), 1e-14);
  EXPECT_LT((filter->estimate().covariance - extended->estimate().covariance).norm(), 1e-18);
}

TEST(Kf, TakesLinearModelsWhoseJacobiansAreDifferences) {
  const auto f = [](const VectorXd& z, const VectorXd&, VectorXd& next) {
    next = Eigen::Vector2d(z[0] + 1e-3 * z[1], z[1] - 0.2 * z[0]) + Eigen::Vector2d(1e3, 7.0);
  };
  const auto h = [](const VectorXd& z, const VectorXd&, VectorXd& y) { y = z.head(1); };
  const auto filter = kf(std::make_unique<FunctionModel>(f, h, MatrixXd::Zero(2, 2), MatrixXd::Ones(1, 1)));
  filter->reset({Eigen::Vector2d(1.0, 0.0), MatrixXd::Identity(2, 2)});
  for (int k = 0; k < 100; ++k) {
    EXPECT_NO_THROW(filter->predict({}));
    EXPECT_NO_THROW(filter->correct(VectorXd::Zero(1), {}));
  }
}

TEST(Kf, RefusesAModelThatTurnsOutNotToBeLinear) {
  // A spring that hardens: linear at rest, but not a deviation away. An output likewise; a kink, when
  // reached.
  const auto cubic = [](const VectorXd& z, const VectorXd&, VectorXd& value) {
    value[0] = z[0] - std::pow(z[0], 3);
  };
  const auto linear = [](const VectorXd& z, const VectorXd&, VectorXd& value) { value[0] = z[0] + 1.0; };
  const auto kink = [](const VectorXd& z, const VectorXd&, VectorXd& value) {
    value[0] = z[0] + 1.0 + std::max(0.0, z[0] - 5.0);
  };
  const MatrixXd none = MatrixXd::Zero(1, 1), one = MatrixXd::Ones(1, 1);
  const filters::Gaussian rest{VectorXd::Zero(1), 0.01 * one};
  const auto motion = kf(std::make_unique<FunctionModel>(cubic, linear, none, one));
  motion->reset(rest);
  EXPECT_THROW(motion->predict({}), std::invalid_argument);
  const auto sensor = kf(std::make_unique<FunctionModel>(linear, cubic, none, one));
  sensor->reset(rest);
  EXPECT_NO_THROW(sensor->predict({}));
  EXPECT_THROW(sensor->correct(VectorXd::Zero(1), {}), std::invalid_argument);
  const auto late = kf(std::make_unique<FunctionModel>(kink, linear, none, one));
  late->reset(rest);
  int step = 0;
  EXPECT_THROW(for (; step < 20; ++step) late->predict({}), std::invalid_argument);
  EXPECT_EQ(step, 5);  // from 5, the kink itself: differences see half of it
}

}  // namespace
}  // namespace beamid::test::kf_test
