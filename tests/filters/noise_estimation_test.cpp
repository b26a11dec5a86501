// Noise from the record. Oracles: closed forms on static models, agreement of two methods, statistics.
#include "filters/noise_estimation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "beamid/testing/linear_model.hpp"
#include "beamid/testing/oscillator.hpp"

namespace beamid::noise_estimation_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::estimate_noise, filters::NoiseEstimate, filters::NoiseMethod, filters::NoiseStatus;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// p independent random walks, each observed.
filters::NoisyFilterFactory walks() {
  return [](const filters::Noise& noise) {
    test::LinearModel model;
    model.a = model.c = MatrixXd::Identity(noise.output.rows(), noise.output.rows());
    model.q = noise.process.size() > 0 ? noise.process : MatrixXd(0.0 * model.a);
    model.r = noise.output;
    return filters::filter_registry().make("ekf", {}, std::make_unique<test::LinearModel>(model));
  };
}

class Walks {
 protected:
  filters::Measurements walk(Index samples, double process, double output, double start = 0.0) {
    filters::Measurements record{
        VectorXd::LinSpaced(samples, 0, static_cast<double>(samples - 1)), MatrixXd(1, samples), {}};
    for (Index k = 0; k < samples; ++k) {
      record.outputs(0, k) = start + output * normal_(random_);
      start += process * normal_(random_);
    }
    return record;
  }

  std::mt19937 random_{8};
  std::normal_distribution<double> normal_;
};

class NoiseFromTheRecord : public Walks, public testing::TestWithParam<NoiseMethod> {};
class NoiseStatistics : public Walks, public testing::Test {};

TEST_P(NoiseFromTheRecord, IsTheMeanSquareAboutAKnownConstant) {
  // Oracle: s^2 = mean y^2, its relative standard error 1 / sqrt(2 N); two outputs with a gap in one.
  filters::Measurements record{VectorXd::LinSpaced(400, 0, 399), MatrixXd(2, 400), {}};
  for (Index k = 0; k < 400; ++k) record.outputs.col(k) << 0.3 * normal_(random_), 7.0 * normal_(random_);
  record.outputs.row(1).segment(50, 100).setConstant(nan);
  const filters::Gaussian known{VectorXd::Zero(2), MatrixXd::Zero(2, 2)};
  const NoiseEstimate estimate =
      estimate_noise(walks(), known, record, {.guess = {{}, MatrixXd::Identity(2, 2)}, .method = GetParam()});
  ASSERT_EQ(estimate.status, NoiseStatus::converged) << estimate.reason;
  const auto there = !record.outputs.row(1).array().isNaN();
  const double second = there.select(record.outputs.row(1), 0.0).squaredNorm() / 300.0;
  EXPECT_NEAR(estimate.noise.output(0, 0) / (record.outputs.row(0).squaredNorm() / 400.0), 1.0, 1e-6);
  EXPECT_NEAR(estimate.noise.output(1, 1) / second, 1.0, 1e-6);
  EXPECT_NEAR(estimate.relative_deviations[0] * std::sqrt(800.0), 1.0, 1e-4);
  EXPECT_NEAR(estimate.relative_deviations[1] * std::sqrt(600.0), 1.0, 1e-4);
}

TEST_P(NoiseFromTheRecord, IsTheSampleVarianceAboutAnUnknownConstant) {
  // Oracle: with a flat prior on the constant, s^2 = sum (y - mean)^2 / (N - 1).
  const filters::Measurements record = walk(60, 0.0, 0.5, 3.0);
  const NoiseEstimate estimate =
      estimate_noise(walks(), {VectorXd::Zero(1), MatrixXd::Constant(1, 1, 1e10)}, record,
                     {.guess = {{}, MatrixXd::Ones(1, 1)}, .method = GetParam()});
  ASSERT_EQ(estimate.status, NoiseStatus::converged) << estimate.reason;
  const double variance = (record.outputs.array() - record.outputs.mean()).square().sum() / 59.0;
  EXPECT_NEAR(estimate.noise.output(0, 0) / variance, 1.0, 1e-5);
}

TEST_P(NoiseFromTheRecord, ScalesTheInitialCovariance) {
  // Oracle: 60 walks without noise of either kind to speak of start from N(0, 4): s^2 = mean z_0^2.
  filters::Measurements record{VectorXd::Zero(1), MatrixXd(60, 1), {}};
  for (double& y : record.outputs.reshaped()) y = 2.0 * normal_(random_);
  const double tiny = 1e-6;
  filters::NoiseSettings settings{.guess = {{}, tiny * MatrixXd::Identity(60, 60)},
                                  .output_groups = {{0}},
                                  .initial_level = true,
                                  .method = GetParam()};
  const NoiseEstimate estimate =
      estimate_noise(walks(), {VectorXd::Zero(60), MatrixXd::Identity(60, 60)}, record, settings);
  EXPECT_NEAR(estimate.levels[1] / std::sqrt(record.outputs.squaredNorm() / 60.0), 1.0, 1e-2);
}

TEST_F(NoiseStatistics, IsTheSameByBothMethodsOnARandomWalk) {
  filters::Measurements record = walk(500, 0.7, 1.5);
  record.outputs.middleCols(100, 20).setConstant(nan);
  const filters::Gaussian initial{VectorXd::Zero(1), MatrixXd::Constant(1, 1, 10.0)};
  filters::NoiseSettings settings{.guess = {MatrixXd::Ones(1, 1), MatrixXd::Ones(1, 1)},
                                  .process_groups = {{0}}};
  const NoiseEstimate likely = estimate_noise(walks(), initial, record, settings);
  settings.method = NoiseMethod::expectation_maximisation;
  const NoiseEstimate expected = estimate_noise(walks(), initial, record, settings);
  ASSERT_EQ(likely.status, NoiseStatus::converged) << likely.reason;
  ASSERT_EQ(expected.status, NoiseStatus::converged) << expected.reason;
  for (Index i = 0; i < 2; ++i) {
    EXPECT_NEAR((expected.levels[i] / likely.levels[i] - 1.0) / likely.relative_deviations[i], 0.0, 2e-3)
        << i;
    EXPECT_NEAR(expected.relative_deviations[i] / likely.relative_deviations[i], 1.0, 1e-2) << i;
  }
  EXPECT_NEAR(likely.levels[0], 1.5, 4.0 * 1.5 * likely.relative_deviations[0]);
  EXPECT_NEAR(likely.levels[1], 0.7, 4.0 * 0.7 * likely.relative_deviations[1]);
  for (std::size_t i = 1; i < expected.log_likelihoods.size(); ++i)
    EXPECT_GE(expected.log_likelihoods[i], expected.log_likelihoods[i - 1] - 1e-9);  // EM never falls
}

TEST_F(NoiseStatistics, HasTheStandardErrorsItTells) {
  // Oracle: 2000 runs: s^2 unbiased, and the scatter of log s as told, 1 / sqrt(2 N), N = 30.
  constexpr int runs = 2000;
  double sum = 0.0, squares = 0.0, told = 0.0;
  for (int i = 0; i < runs; ++i) {
    const NoiseEstimate estimate = estimate_noise(walks(), {VectorXd::Zero(1), MatrixXd::Zero(1, 1)},
                                                  walk(30, 0.0, 0.4), {.guess = {{}, MatrixXd::Ones(1, 1)}});
    ASSERT_EQ(estimate.status, NoiseStatus::converged);
    sum += estimate.noise.output(0, 0) / 0.16;
    squares += std::pow(std::log(estimate.levels[0] / 0.4), 2);
    told += std::pow(estimate.relative_deviations[0], 2);
  }
  EXPECT_NEAR(sum / runs, 1.0, 3.3 * std::sqrt(2.0 / (30.0 * runs)));
  EXPECT_NEAR(std::sqrt(squares / told), 1.0, 0.1);  // 1/N terms and scatter
}

TEST_F(NoiseStatistics, IsFoundWhileStiffnessAndDampingAre) {
  // Oracle: the noise that the record was made with, by the joint identification of an oscillator.
  const double dt = 4e-3, noise = 2e-4;
  const auto make = [&](const filters::Noise& levels) {
    return filters::filter_registry().make(
        "ekf", {}, filters::discretise(std::make_shared<test::Oscillator>(3.0), dt, "exponential", levels));
  };
  const auto model = filters::discretise(std::make_shared<test::Oscillator>(3.0), dt, "exponential",
                                         {{}, MatrixXd::Ones(1, 1)});
  filters::Measurements record{VectorXd::LinSpaced(1000, 0.0, 999 * dt), MatrixXd(1, 1000), {}};
  VectorXd z = Eigen::Vector4d(0.012, 0.0, 515.8, 1.2), next;
  for (Index k = 0; k < 1000; ++k) {
    record.outputs(0, k) = z[0] + noise * normal_(random_);
    model->transition(z, {}, next);
    z.swap(next);
  }
  const filters::Gaussian initial{Eigen::Vector4d(0.012, 0.0, 480.0, 2.0),
                                  Eigen::Vector4d(1e-6, 1e-4, 2500.0, 1.0).asDiagonal()};
  const NoiseEstimate estimate =
      estimate_noise(make, initial, record, {.guess = {{}, MatrixXd::Constant(1, 1, 1e-6)}});
  ASSERT_EQ(estimate.status, NoiseStatus::converged) << estimate.reason;
  EXPECT_NEAR(std::sqrt(estimate.noise.output(0, 0)) / noise, 1.0, 3.3 / std::sqrt(2000.0));
  EXPECT_NEAR(estimate.relative_deviations[0] * std::sqrt(2000.0), 1.0, 0.05);
}

TEST_P(NoiseFromTheRecord, MultipliesDeviationsThatTheRecordBrings) {
  // Oracle: s^2 = mean (y / deviation)^2.
  filters::Measurements record = walk(300, 0.0, 1.0);
  record.output_deviations = MatrixXd(1, 300);
  for (Index k = 0; k < 300; ++k) record.output_deviations(0, k) = 0.1 + 0.001 * static_cast<double>(k);
  record.outputs.array() *= 3.0 * record.output_deviations.array();
  const NoiseEstimate estimate = estimate_noise(walks(), {VectorXd::Zero(1), MatrixXd::Zero(1, 1)}, record,
                                                {.guess = {{}, MatrixXd::Ones(1, 1)}, .method = GetParam()});
  ASSERT_EQ(estimate.status, NoiseStatus::converged) << estimate.reason;
  const double expected =
      std::sqrt((record.outputs.array() / record.output_deviations.array()).square().mean());
  EXPECT_NEAR(estimate.levels[0] / expected, 1.0, 1e-6);
}

TEST_F(NoiseStatistics, TellsThatProcessNoiseIsNotThere) {
  const NoiseEstimate estimate =
      estimate_noise(walks(), {VectorXd::Zero(1), MatrixXd::Ones(1, 1)}, walk(300, 0.0, 1.0),
                     {.guess = {MatrixXd::Ones(1, 1), MatrixXd::Ones(1, 1)}, .process_groups = {{0}}});
  EXPECT_EQ(estimate.status, NoiseStatus::converged) << estimate.reason;
  EXPECT_LT(estimate.levels[1], 0.1);
  EXPECT_GT(estimate.relative_deviations[1], 0.3);
}

TEST_F(NoiseStatistics, RefusesLevelsThatDoNotFit) {
  const filters::Measurements record = walk(20, 1.0, 1.0);
  const filters::Gaussian initial{VectorXd::Zero(1), MatrixXd::Ones(1, 1)};
  const auto refused = [&](const filters::NoiseSettings& settings) {
    EXPECT_THROW(estimate_noise(walks(), initial, record, settings), std::invalid_argument);
  };
  const MatrixXd one = MatrixXd::Ones(1, 1);
  refused({.guess = {{}, MatrixXd::Ones(2, 2)}});
  refused({.guess = {{}, MatrixXd::Zero(1, 1)}});
  refused({.guess = {{}, one}, .output_groups = {{1}}});
  refused({.guess = {{}, one}, .output_groups = {{0}, {0}}});
  refused({.guess = {{}, one}, .process_groups = {{0}}});
  refused({.guess = {MatrixXd::Zero(1, 1), one}, .process_groups = {{0}}});
  refused({.guess = {{}, one}, .tolerance = 0.0});
}

INSTANTIATE_TEST_SUITE_P(ByEitherMethod, NoiseFromTheRecord,
                         testing::Values(NoiseMethod::maximum_likelihood,
                                         NoiseMethod::expectation_maximisation),
                         [](const auto& tested) {
                           return tested.param == NoiseMethod::maximum_likelihood ? "Likelihood"
                                                                                  : "Expectation";
                         });

}  // namespace
}  // namespace beamid::noise_estimation_test
