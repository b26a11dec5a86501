// Conformance: every registered filter keeps the contracts it declares. A new one is found by itself.
#include <gtest/gtest.h>

#include <limits>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "filters/filter_run.hpp"
#include "tests/filters/linear_model.hpp"
#include "tests/filters/oscillator.hpp"

namespace beamid {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::filter_registry, filters::Gaussian;

constexpr double mass = 3.0, stiffness = 515.8, damping = 7.867;  // damping ratio 10 %

// N samples of a free decay from [x0, 0], exact, with white noise of the given deviation on each output.
filters::Measurements decay(int outputs, Index samples, double dt, double noise, std::mt19937& random,
                            double x0) {
  const auto model = filters::discretise(std::make_shared<test::Oscillator>(mass, outputs), dt, "exponential",
                                         {{}, MatrixXd::Identity(outputs, outputs)});
  std::normal_distribution<double> normal;
  filters::Measurements record{VectorXd(samples), MatrixXd(outputs, samples), {}};
  VectorXd z(4), next, y;
  z << x0, 0.0, stiffness, damping;
  for (Index k = 0; k < samples; ++k) {
    record.time[k] = static_cast<double>(k) * dt;
    for (Index i = 0; i < outputs; ++i) record.outputs(i, k) = z[i] + noise * normal(random);
    model->transition(z, {}, next);
    z.swap(next);
  }
  return record;
}

class EveryFilter : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<filters::Filter> make(std::unique_ptr<filters::DiscreteModel> model) {
    return filter_registry().make(GetParam(), {}, std::move(model));
  }
  std::unique_ptr<filters::Filter> oscillator(int outputs, double dt, double noise) {
    const MatrixXd r = noise * noise * MatrixXd::Identity(outputs, outputs);
    return make(
        filters::discretise(std::make_shared<test::Oscillator>(mass, outputs), dt, "exponential", {{}, r}));
  }
  bool declares(const char* contract) {
    return filter_registry().find(GetParam()).contracts.contains(contract);
  }
};

TEST_P(EveryFilter, ReproducesThePublishedCase) {
  // Oracle: the same recursion in exact rational arithmetic. (A published float result of this
  // case, 6.71906243764755 and 1.52810614201467, agrees to nine digits only.)
  if (!declares(filters::contract::exact_on_linear_gaussian)) GTEST_SKIP() << "not promised";
  test::LinearModel model;
  model.a.resize(2, 2), model.c.resize(1, 2);
  model.a << 1, 1, 0, 1;
  model.c << 0.5, -0.3;
  model.q = 2.0 * MatrixXd::Identity(2, 2);
  model.r = MatrixXd::Constant(1, 1, 0.5);
  const auto filter = make(std::make_unique<test::LinearModel>(model));
  Gaussian initial{VectorXd::Ones(2), MatrixXd(2, 2)};
  initial.covariance << 1, 0.1, 0.1, 1;
  filters::Measurements record{VectorXd::LinSpaced(3, 0, 2), MatrixXd(1, 3), {}};
  record.outputs << 1, 2, 3;
  const auto result =
      run(*filter, initial, record, filters::Keep::all_beliefs, filters::Start::one_interval_before);
  ASSERT_FALSE(result.failure);
  EXPECT_NEAR(result.last.mean[0], 6.71906243590896, 1e-14);
  EXPECT_NEAR(result.last.mean[1], 1.5281061413773416, 1e-14);
  EXPECT_NEAR(result.last.covariance(0, 0), 4.390246585980715, 1e-14);
  EXPECT_NEAR(result.last.covariance(0, 1), 3.90194406652603, 1e-14);
  EXPECT_NEAR(result.last.covariance(1, 1), 5.409573044716606, 1e-14);
}

TEST_P(EveryFilter, EqualsTheKalmanFilterOnLinearModels) {
  // Oracle: the information form, P^-1 = (A P A^T + Q)^-1 + C^T R^-1 C: another algorithm for the same
  // posterior.
  if (!declares(filters::contract::exact_on_linear_gaussian)) GTEST_SKIP() << "not promised";
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto gaussian = [&](Index rows, Index columns) {
    return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); }).eval();
  };
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Index n = 1 + repeat % 5, p = 1 + repeat % 3, samples = 30;
    test::LinearModel model;
    model.a = 0.9 / std::sqrt(static_cast<double>(n)) * gaussian(n, n);
    model.c = gaussian(p, n);
    const MatrixXd q = gaussian(n, n), r = gaussian(p, p);
    model.q = q * q.transpose();
    model.r = r * r.transpose() + 0.1 * MatrixXd::Identity(p, p);
    const filters::Measurements record{VectorXd::LinSpaced(samples, 0, 1), gaussian(p, samples), {}};
    const auto filter = make(std::make_unique<test::LinearModel>(model));
    const auto result = run(*filter, {VectorXd::Zero(n), MatrixXd::Identity(n, n)}, record);

    VectorXd mean = VectorXd::Zero(n);
    MatrixXd covariance = MatrixXd::Identity(n, n);
    double log_likelihood = 0.0;
    for (Index k = 0; k < samples; ++k) {
      if (k > 0) {
        mean = model.a * mean;
        covariance = model.a * covariance * model.a.transpose() + model.q;
      }
      const MatrixXd s = model.c * covariance * model.c.transpose() + model.r;
      const VectorXd innovation = record.outputs.col(k) - model.c * mean;
      log_likelihood -=
          0.5 * (innovation.dot(s.inverse() * innovation) + std::log((2 * M_PI * s).determinant()));
      const MatrixXd information = covariance.inverse() + model.c.transpose() * model.r.inverse() * model.c;
      const VectorXd vector =
          covariance.inverse() * mean + model.c.transpose() * model.r.inverse() * record.outputs.col(k);
      covariance = information.inverse();
      mean = covariance * vector;
    }
    EXPECT_LT((result.last.mean - mean).norm(), 1e-10 * (1 + mean.norm()));
    EXPECT_LT((result.last.covariance - covariance).norm(), 1e-10 * covariance.norm());
    EXPECT_NEAR(result.log_likelihood / log_likelihood, 1.0, 1e-10);
  }
}

TEST_P(EveryFilter, KeepsItsCovarianceSymmetricAndPositive) {
  // The paper's wide prior (variance 1e5 on K and C) against a noise of 1e-5: ten decades, every step
  // inspected.
  std::mt19937 random(3);
  const auto record = decay(2, 2000, 1e-3, 0.0, random, 0.012);
  const auto filter = oscillator(2, 1e-3, std::sqrt(1e-5));
  VectorXd mean(4);
  mean << 0.012, 0.0, 300.0, 2.0;
  const Eigen::Vector4d variance(1.0, 1.0, 1e5, 1e5);
  const auto result = run(*filter, {mean, variance.asDiagonal()}, record, filters::Keep::all_beliefs);
  ASSERT_FALSE(result.failure) << result.failure->reason;
  for (const Gaussian& belief : result.filtered) {
    ASSERT_EQ((belief.covariance - belief.covariance.transpose()).norm(), 0.0);
    const VectorXd scale = belief.covariance.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> correlation(scale.asDiagonal() * belief.covariance *
                                                              scale.asDiagonal());
    ASSERT_GT(correlation.eigenvalues()[0], 0.0);
  }
}

TEST_P(EveryFilter, IdentifiesWithoutNoiseToSixDigits) {
  std::mt19937 random(1);
  const auto record = decay(1, 3000, 1e-3, 0.0, random, 0.012);
  const auto filter = oscillator(1, 1e-3, 1e-9);
  VectorXd mean(4);
  mean << 0.012, 0.0, 0.9 * stiffness, 1.2 * damping;
  const Eigen::Vector4d variance(1e-6, 1e-4, 1e4, 10.0);
  const auto result = run(*filter, {mean, variance.asDiagonal()}, record);
  ASSERT_FALSE(result.failure) << result.failure->reason;
  EXPECT_NEAR(result.last.mean[2] / stiffness, 1.0, 1e-6);
  EXPECT_NEAR(result.last.mean[3] / damping, 1.0, 1e-6);
}

TEST_P(EveryFilter, ErrsAsMuchAsItSays) {
  // Oracle: mean normalised estimation error squared over N runs is chi-square(4 N)/N; its 99.9 % band
  // [wilson-hilferty]. The truth is drawn from the prior, as the filter is told.
  if (!declares(filters::contract::consistent)) GTEST_SKIP() << "not promised";
  constexpr int runs = 300;
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  double sum = 0.0;
  for (int i = 0; i < runs; ++i) {
    const double noise = 1e-4;
    const auto record = decay(1, 1500, 2e-3, noise, random, 0.012);
    const auto filter = oscillator(1, 2e-3, noise);
    const Eigen::Vector4d truth(0.012, 0.0, stiffness, damping), deviation(2e-4, 2e-3, 15.0, 1.0);
    const VectorXd mean =
        truth + deviation.cwiseProduct(Eigen::Vector4d::NullaryExpr([&] { return normal(random); }));
    const auto result = run(*filter, {mean, deviation.cwiseAbs2().asDiagonal()}, record);
    ASSERT_FALSE(result.failure);
    // K and C do not move, so the error of the last belief about them has two degrees of freedom.
    const Eigen::Vector2d error = result.last.mean.tail<2>() - truth.tail<2>();
    const Eigen::Matrix2d covariance = result.last.covariance.bottomRightCorner<2, 2>();
    sum += error.dot(covariance.inverse() * error);
  }
  const double freedoms = 2.0 * runs, spread = 3.29 * std::sqrt(2.0 / (9.0 * freedoms));
  const double centre = 1.0 - 2.0 / (9.0 * freedoms);
  EXPECT_GT(sum / runs, 2.0 * std::pow(centre - spread, 3));
  EXPECT_LT(sum / runs, 2.0 * std::pow(centre + spread, 3));
}

TEST_P(EveryFilter, ChangesNothingWhenUnitsChange) {
  // Metres to micrometres: K and C, which are ratios of the motion, must not move.
  std::mt19937 random(5);
  auto record = decay(1, 1000, 1e-3, 1e-4, random, 0.012);
  const Eigen::Vector4d mean(0.012, 0.0, 500.0, 9.0), deviation(1e-3, 1e-2, 30.0, 3.0);
  const auto in_metres =
      run(*oscillator(1, 1e-3, 1e-4), {mean, MatrixXd(deviation.cwiseAbs2().asDiagonal())}, record);
  record.outputs *= 1e6;
  const Eigen::Vector4d scale(1e6, 1e6, 1.0, 1.0);
  const auto in_micrometres = run(
      *oscillator(1, 1e-3, 1e2),
      {scale.cwiseProduct(mean), MatrixXd(scale.cwiseProduct(deviation).cwiseAbs2().asDiagonal())}, record);
  EXPECT_NEAR(in_micrometres.last.mean[2] / in_metres.last.mean[2], 1.0, 1e-9);
  EXPECT_NEAR(in_micrometres.last.mean[3] / in_metres.last.mean[3], 1.0, 1e-9);
}

TEST_P(EveryFilter, ReportsWhereItFailed) {
  std::mt19937 random(1);
  auto record = decay(1, 100, 1e-3, 0.0, random, 0.012);
  record.outputs(0, 60) = std::numeric_limits<double>::infinity();
  const Eigen::Vector4d mean(0.012, 0.0, 500.0, 9.0), variance(1e-6, 1e-4, 1e2, 1.0);
  const auto result =
      run(*oscillator(1, 1e-3, 1e-4), {mean, variance.asDiagonal()}, record, filters::Keep::all_beliefs);
  ASSERT_TRUE(result.failure);
  EXPECT_EQ(result.failure->step, 60);
  EXPECT_NEAR(result.failure->time, 0.060, 1e-12);
  EXPECT_FALSE(result.failure->reason.empty());
  EXPECT_EQ(result.filtered.size(), 60u);  // the partial run is kept
}

TEST_P(EveryFilter, RefusesBeliefsThatDoNotFit) {
  const auto filter = oscillator(1, 1e-3, 1e-4);
  EXPECT_THROW(filter->reset({VectorXd::Zero(3), MatrixXd::Identity(3, 3)}), std::invalid_argument);
  MatrixXd lopsided = MatrixXd::Identity(4, 4);
  lopsided(0, 1) = 0.5;
  EXPECT_THROW(filter->reset({VectorXd::Zero(4), lopsided}), std::invalid_argument);
  EXPECT_THROW(filter->reset({VectorXd::Zero(4), -MatrixXd::Identity(4, 4)}), std::invalid_argument);
}

TEST_P(EveryFilter, RejectsUnknownOptions) {
  EXPECT_THROW(filter_registry().completed(GetParam(), {{"no_such_option", 1.0}}), std::invalid_argument);
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const auto& [name, entry] : filter_registry().entries()) result.push_back(name);
  return result;
}
INSTANTIATE_TEST_SUITE_P(Registered, EveryFilter, testing::ValuesIn(names()),
                         [](const auto& tested) { return tested.param; });

}  // namespace
}  // namespace beamid
