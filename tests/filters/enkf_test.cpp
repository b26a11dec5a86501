// Ensembles against the filters that they approximate.
#include <gtest/gtest.h>

#include <cmath>

#include "beamid/testing/kalman_recursion.hpp"
#include "beamid/testing/known_oscillator.hpp"
#include "filters/filter_run.hpp"

namespace beamid::test::enkf_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::filter_registry, filters::Gaussian;

const std::string variants[] = {"stochastic", "transform"};

std::unique_ptr<filters::Filter> enkf(const std::string& update, double members, const LinearModel& model,
                                      double seed = 1.0) {
  return filter_registry().make("enkf", {{"update", update}, {"members", members}, {"seed", seed}},
                                std::make_unique<LinearModel>(model));
}

TEST(Enkf, IsTheKalmanFilterFromTwoMembersAStateOn) {
  // Oracle: the information form. Three states and outputs: 7 members hold all moments.
  std::mt19937 random(3);
  const LinearModel model = random_model(3, 3, random);
  const MatrixXd readings = random_readings(3, 50, random);
  for (const std::string& update : variants) {
    const auto filter = enkf(update, 7.0, model);
    filter->reset({VectorXd::Zero(3), MatrixXd::Identity(3, 3)});
    KalmanRecursion expected{model, VectorXd::Zero(3), MatrixXd::Identity(3, 3)};
    for (Index k = 0; k < readings.cols(); ++k) {
      filter->predict({});
      expected.predict();
      filter->correct(readings.col(k), {});
      expected.correct(readings.col(k));
    }
    EXPECT_LT((filter->estimate().mean - expected.mean).norm(), 1e-11) << update;
    EXPECT_LT((filter->estimate().covariance - expected.covariance).norm(), 1e-11) << update;
    EXPECT_TRUE(filter->remarks().empty());
  }
}

TEST(Enkf, SaysWhereItsMembersAreTooFew) {
  std::mt19937 random(3);
  const LinearModel model = random_model(5, 1, random);
  for (const std::string& update : variants) {
    const auto filter = enkf(update, 5.0, model);
    filter->reset({VectorXd::Zero(5), MatrixXd::Identity(5, 5)});
    filter->predict({});
    filter->correct(VectorXd::Zero(1), {});
    ASSERT_EQ(filter->remarks().size(), 1u);
    EXPECT_NE(filter->remarks()[0].find("5 members are too few"), std::string::npos);
    EXPECT_TRUE(filter->estimate().mean.allFinite());
  }
}

TEST(Enkf, OfTooFewMembersDrawsDeviationsWithinOneOverTheRootOfTwiceTheirNumber) {
  // Oracle: a sample variance of N normal draws scatters by sqrt(2 / N) of itself, its root by half of that.
  // 60 states, 25 seeds: the scatter itself is known to 1.8 %, hence the bands of 4 of its deviations.
  constexpr double members = 50.0;
  std::mt19937 random(3);
  const LinearModel model = random_model(60, 1, random);
  double of_variance = 0.0, of_deviation = 0.0;
  for (int seed = 1; seed <= 25; ++seed) {
    const auto filter = enkf("transform", members, model, seed);
    filter->reset({VectorXd::Zero(60), MatrixXd::Identity(60, 60)});
    const Eigen::ArrayXd variance = filter->estimate().covariance.diagonal().array();
    of_variance += (variance - 1.0).square().mean() / 25.0;
    of_deviation += (variance.sqrt() - 1.0).square().mean() / 25.0;
  }
  EXPECT_NEAR(std::sqrt(of_variance) / std::sqrt(2.0 / members), 1.0, 0.07);
  EXPECT_NEAR(std::sqrt(of_deviation) / std::sqrt(0.5 / members), 1.0, 0.07);
}

TEST(Enkf, ErrsAsMuchAsItSaysOnTheOscillator) {
  // Oracle: NEES of K and C over 40 runs is chi-square of 80 degrees / 40: 99.9 % within 1.1 and 3.2.
  for (const std::string& update : variants) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    double sum = 0.0;
    for (int i = 0; i < 40; ++i) {
      const auto record = decay(1, 750, 4e-3, 1e-4, random);
      const Eigen::Vector4d truth(0.012, 0.0, stiffness, damping), deviation(2e-4, 2e-3, 15.0, 1.0);
      const Eigen::Vector4d mean =
          truth + deviation.cwiseProduct(Eigen::Vector4d::NullaryExpr([&] { return normal(random); }));
      const auto filter =
          filter_registry().make("enkf", {{"update", update}, {"members", 20.0}}, joint_model(1, 4e-3, 1e-4));
      const auto result = run(*filter, {mean, MatrixXd(deviation.cwiseAbs2().asDiagonal())}, record);
      ASSERT_FALSE(result.failure);
      const Eigen::Vector2d error = (result.last.mean - truth).tail<2>();
      sum += error.dot(result.last.marginal(2, 2).ldlt().solve(error));
    }
    EXPECT_GT(sum / 40.0, 1.1) << update;
    EXPECT_LT(sum / 40.0, 3.2) << update;
  }
}

TEST(Enkf, GivesTheSameNumbersForTheSameSeedOnly) {
  std::mt19937 random(4);
  const LinearModel model = random_model(5, 1, random);
  const auto mean = [&](double seed) {
    const auto filter = enkf("stochastic", 4.0, model, seed);
    for (int repeat = 0; repeat < 2; ++repeat) {  // a reset starts the draws anew
      filter->reset({VectorXd::Zero(5), MatrixXd::Identity(5, 5)});
      filter->predict({});
      filter->correct(VectorXd::Ones(1), {});
    }
    return VectorXd(filter->estimate().mean);
  };
  EXPECT_EQ(mean(1.0), mean(1.0));
  EXPECT_NE(mean(1.0), mean(2.0));
}

TEST(Enkf, InflatesItsAnomalies) {
  // Oracle: A P A^T + Q times the square of the factor.
  std::mt19937 random(5);
  const LinearModel model = random_model(2, 1, random);
  const auto filter =
      filter_registry().make("enkf", {{"inflation", 1.1}}, std::make_unique<LinearModel>(model));
  filter->reset({VectorXd::Zero(2), MatrixXd::Identity(2, 2)});
  filter->predict({});
  const MatrixXd expected = 1.21 * (model.a * model.a.transpose() + model.q);
  EXPECT_LT((filter->estimate().covariance - expected).norm(), 1e-12 * expected.norm());
}

TEST(Enkf, RefusesOptionsThatMeanNothing) {
  const auto make = [](const filters::Options& options) {
    return filter_registry().make("enkf", options, joint_model(1, 1e-3, 1.0));
  };
  EXPECT_THROW(make({{"update", std::string("transfrom")}}), std::invalid_argument);
  EXPECT_THROW(make({{"members", 1.0}}), std::invalid_argument);
  EXPECT_THROW(make({{"members", 10.5}}), std::invalid_argument);
  EXPECT_THROW(make({{"inflation", 0.9}}), std::invalid_argument);
  EXPECT_THROW(make({{"seed", -1.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::test::enkf_test
