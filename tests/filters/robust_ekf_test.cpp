// Weights of outlying readings.
#include <gtest/gtest.h>

#include <cmath>

#include "beamid/testing/known_oscillator.hpp"
#include "beamid/testing/linear_model.hpp"
#include "filters/filter_run.hpp"

namespace beamid::test::robust_ekf_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using filters::filter_registry, filters::Options;

// Two readings of one state, the first wrong by `error`; how far the mean moves from 0, in prior deviations.
double moved(const Options& options, double error, double prior, int outputs = 2) {
  LinearModel model;
  model.a = MatrixXd::Identity(1, 1);
  model.c = MatrixXd::Ones(outputs, 1);
  model.r = MatrixXd::Identity(outputs, outputs);
  model.q = MatrixXd::Zero(1, 1);
  const auto filter = filter_registry().make("robust_ekf", options, std::make_unique<LinearModel>(model));
  filter->reset({VectorXd::Zero(1), MatrixXd::Constant(1, 1, prior * prior)});
  VectorXd y = VectorXd::Zero(outputs);
  y[0] = error;
  filter->correct(y, {});
  return filter->estimate().mean[0] / prior;
}

TEST(RobustEkf, LimitsOrIgnoresASingleOutlierHoweverLarge) {
  // Oracle: huber: gain times threshold, c P / sqrt(P + R); student_t: (d + 1) P / |nu|, towards zero.
  for (const double prior : {0.1, 1.0, 10.0}) {
    const double limit = 1.345 * prior / std::sqrt(prior * prior + 1.0);
    for (const double error : {1e2, 1e4, 1e8})
      EXPECT_NEAR(moved({{"weight", std::string("huber")}}, error, prior, 1), limit, 1e-9) << prior;
    EXPECT_NEAR(moved({}, 1e8, prior, 1), 5.0 * prior / 1e8, 1e-9);
  }
}

TEST(RobustEkf, FollowsTheOtherOutputWhereThePriorIsWide) {
  // Oracle: the mean lies at the good reading, at 0. Its deviation is 1, the prior's 100: told by either
  // alone both readings would do.
  EXPECT_LT(std::abs(moved({}, 50.0, 100.0)) * 100.0, 26.0);  // two that disagree, equally likely: between
  EXPECT_LT(std::abs(moved({}, 500.0, 100.0)) * 100.0, 1.0);
}

TEST(RobustEkf, IsTheExtendedFilterWhereReadingsAreOrdinary) {
  // Oracle: gain 1/2 of a reading half a deviation away.
  EXPECT_NEAR(moved({}, 0.5, 1.0, 1), 0.25, 1e-15);
  EXPECT_NEAR(moved({{"weight", std::string("huber")}}, 1.0, 1.0, 1), 0.5, 1e-15);
}

TEST(RobustEkf, LosesLittleOnGaussianReadings) {
  // Oracle: the extended filter's errors in 40 runs; 5 % is the published cost of huber's threshold, and
  // student_t of 4 degrees costs as much again.
  for (const char* weight : {"student_t", "huber"}) {
    std::mt19937 random(12);
    std::normal_distribution<double> normal;
    double robust = 0.0, extended = 0.0;
    for (int i = 0; i < 40; ++i) {
      const auto record = decay(1, 750, 4e-3, 1e-4, random);
      const Eigen::Vector4d truth(0.012, 0.0, stiffness, damping), deviation(2e-4, 2e-3, 15.0, 1.0);
      const Eigen::Vector4d mean =
          truth + deviation.cwiseProduct(Eigen::Vector4d::NullaryExpr([&] { return normal(random); }));
      const filters::Gaussian initial{mean, MatrixXd(deviation.cwiseAbs2().asDiagonal())};
      const auto filter =
          filter_registry().make("robust_ekf", {{"weight", std::string(weight)}}, joint_model(1, 4e-3, 1e-4));
      const auto plain = filter_registry().make("ekf", {}, joint_model(1, 4e-3, 1e-4));
      robust += std::pow(run(*filter, initial, record).last.mean[2] - stiffness, 2);
      extended += std::pow(run(*plain, initial, record).last.mean[2] - stiffness, 2);
    }
    EXPECT_LT(std::sqrt(robust / extended), 1.2) << weight;
  }
}

TEST(RobustEkf, RefusesOptionsThatMeanNothing) {
  const auto make = [](const Options& options) {
    return filter_registry().make("robust_ekf", options, joint_model(1, 1e-3, 1.0));
  };
  EXPECT_THROW(make({{"weight", std::string("cauchy")}}), std::invalid_argument);
  EXPECT_THROW(make({{"degrees", 0.0}}), std::invalid_argument);
  EXPECT_THROW(make({{"threshold", -1.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::test::robust_ekf_test
