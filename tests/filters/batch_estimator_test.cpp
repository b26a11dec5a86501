// All samples at once. Oracles: closed forms of linear least squares, the Cramer-Rao bound, exact motion.
#include "filters/batch_estimator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>

#include "beamid/testing/linear_model.hpp"
#include "beamid/testing/oscillator.hpp"
#include "filters/fisher_information.hpp"

namespace beamid::batch_estimator_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::BatchEstimate, filters::BatchSettings, filters::BatchStatus, filters::estimate_batch;

constexpr double mass = 3.0, stiffness = 515.8, nan = std::numeric_limits<double>::quiet_NaN();

std::unique_ptr<filters::DiscreteModel> oscillator(double dt, double noise, bool forced = false) {
  return filters::discretise(std::make_shared<test::Oscillator>(mass, 1, forced), dt, "exponential",
                             {{}, MatrixXd::Constant(1, 1, noise * noise)});
}

// The exact motion from z at these times, observed without noise; the force, if any, is held.
filters::Measurements motion(VectorXd z, const VectorXd& time, const MatrixXd& force = {}) {
  const auto model = oscillator(1.0, 1.0, force.size() > 0);
  filters::Measurements record{time, MatrixXd(1, time.size()), force};
  VectorXd next, input;
  for (Index k = 0; k < time.size(); ++k) {
    if (k > 0) {
      model->set_interval(time[k] - time[k - 1]);
      model->transition(z, input, next);
      z.swap(next);
    }
    record.outputs(0, k) = z[0];
    if (force.size() > 0) input = force.col(k);
  }
  return record;
}

VectorXd stamps(Index samples, double dt) {
  return VectorXd::LinSpaced(samples, 0.0, dt * static_cast<double>(samples - 1));
}

TEST(BatchEstimator, IsLinearLeastSquaresOnALinearModel) {
  // Oracle: the stacked system L^-1 C A^k S c = L^-1 (y_k - C A^k z_0), U c = 0.
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto gaussian = [&](Index rows, Index columns) {
    return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); }).eval();
  };
  test::LinearModel model;
  model.a = 0.5 * gaussian(4, 4);
  model.c = gaussian(2, 4);
  const MatrixXd r = gaussian(2, 2);
  model.r = r * r.transpose() + 0.1 * MatrixXd::Identity(2, 2);
  const VectorXd start = gaussian(4, 1);
  const MatrixXd directions = gaussian(4, 3), prior = gaussian(2, 3);
  const filters::Measurements record{stamps(30, 1.0), gaussian(2, 30), {}};
  const MatrixXd root = model.r.llt().matrixL();
  MatrixXd rows(62, 3), power = MatrixXd::Identity(4, 4);
  VectorXd right = VectorXd::Zero(62);
  for (Index k = 0; k < 30; ++k) {
    const MatrixXd seen = root.inverse() * model.c * power;
    rows.middleRows(2 * k, 2) = seen * directions;
    right.segment(2 * k, 2) = root.inverse() * record.outputs.col(k) - seen * start;
    power = model.a * power;
  }
  rows.bottomRows(2) = prior;
  const VectorXd expected = rows.colPivHouseholderQr().solve(right);
  const MatrixXd covariance = (rows.transpose() * rows).inverse();
  const BatchEstimate estimate = estimate_batch(model, start, directions, record, {.prior_factor = prior});
  ASSERT_EQ(estimate.status, BatchStatus::converged) << estimate.reason;
  EXPECT_LT((estimate.coefficients - expected).norm(), 1e-11 * expected.norm());
  EXPECT_LT((estimate.covariance - covariance).norm(), 1e-10 * covariance.norm());
  EXPECT_LT((estimate.state - start - directions * expected).norm(), 1e-12);
  EXPECT_EQ(estimate.measured, 60);
}

TEST(BatchEstimator, IsExactWithoutNoise) {
  // Oracle: the truth; K guessed at 0.7 and C at 3 times it, a record of 13 cycles.
  const Eigen::Vector4d truth(0.012, -0.03, stiffness, 1.2);
  const filters::Measurements record = motion(truth, stamps(1500, 4e-3));
  const Eigen::Vector4d guess(0.012, 0.0, 0.7 * stiffness, 3.6);
  const BatchEstimate estimate =
      estimate_batch(*oscillator(4e-3, 1e-4), guess, MatrixXd::Identity(4, 4), record, {.first_samples = 50});
  ASSERT_EQ(estimate.status, BatchStatus::converged) << estimate.reason;
  EXPECT_LT((estimate.state.cwiseQuotient(truth).array() - 1.0).abs().maxCoeff(), 1e-9);
  for (std::size_t i = 1; i < estimate.costs.size(); ++i) EXPECT_LT(estimate.costs[i], estimate.costs[i - 1]);
}

TEST(BatchEstimator, TakesIrregularTimesGapsAndForces) {
  // Oracle: the truth, where half of the samples are missing and no two intervals are alike.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.2, 1.8);
  std::normal_distribution<double> normal;
  const Index samples = 800;
  VectorXd time(samples);
  MatrixXd force(1, samples);
  double t = 3.0;
  for (Index k = 0; k < samples; ++k) {
    time[k] = t += 5e-3 * uniform(random);
    force(0, k) = normal(random);
  }
  const Eigen::Vector4d truth(0.012, -0.03, stiffness, 1.2);
  filters::Measurements record = motion(truth, time, force);
  for (Index k = 0; k < samples; ++k)
    if (uniform(random) < 1.0) record.outputs(0, k) = nan;
  const auto model = oscillator(5e-3, 1e-4, true);
  const BatchEstimate estimate = estimate_batch(*model, Eigen::Vector4d(0.0, 0.0, 0.98 * stiffness, 2.0),
                                                MatrixXd::Identity(4, 4), record);
  ASSERT_EQ(estimate.status, BatchStatus::converged) << estimate.reason;
  EXPECT_LT((estimate.state.cwiseQuotient(truth).array() - 1.0).abs().maxCoeff(), 1e-9);
  EXPECT_EQ(estimate.measured, samples - record.outputs.array().isNaN().count());
  EXPECT_EQ(model->interval(), 5e-3);
}

TEST(BatchEstimator, MeetsTheCramerRaoBound) {
  // Oracle: the bound, and J: 2 J is chi-square of N - 4 degrees. 2000 runs: rms known to 1.6 %.
  constexpr int runs = 2000;
  constexpr double dt = 0.02, noise = 2e-4;
  const Eigen::Vector4d truth(0.012, -0.03, stiffness, 1.2);
  const filters::Measurements exact = motion(truth, stamps(150, dt));
  const auto model = oscillator(dt, noise);
  const VectorXd bound = filters::cramer_rao_bound(filters::fisher_information(*model, truth, 150));
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0.0, noise);
  VectorXd squares = VectorXd::Zero(4);
  double cost = 0.0;
  for (int i = 0; i < runs; ++i) {
    filters::Measurements record = exact;
    for (double& y : record.outputs.reshaped()) y += normal(random);
    const BatchEstimate estimate = estimate_batch(*model, Eigen::Vector4d(0.012, 0.0, 1.05 * stiffness, 2.0),
                                                  MatrixXd::Identity(4, 4), record);
    ASSERT_EQ(estimate.status, BatchStatus::converged) << i << ": " << estimate.reason;
    squares += (estimate.state - truth).cwiseAbs2();
    cost += estimate.costs.back();
  }
  const VectorXd ratio = (squares / runs).cwiseSqrt().cwiseQuotient(bound);
  for (Index i = 0; i < 4; ++i) {
    EXPECT_GT(ratio[i], 0.95) << i;
    EXPECT_LT(ratio[i], 1.05) << i;
  }
  EXPECT_NEAR(2.0 * cost / runs / 146.0, 1.0, 3.3 * std::sqrt(2.0 / (146.0 * runs)));
}

TEST(BatchEstimator, WeighsSamplesByTheirOwnNoise) {
  // Oracle: the weighted mean of a constant, sum y/s^2 / sum 1/s^2.
  test::LinearModel model;
  model.a = model.c = model.r = MatrixXd::Ones(1, 1);
  filters::Measurements record{stamps(4, 1.0), MatrixXd(1, 4), {}, MatrixXd(1, 4)};
  record.outputs << 1.0, 2.0, nan, 4.0;
  record.output_deviations << 1.0, 0.5, nan, 2.0;
  const BatchEstimate estimate = estimate_batch(model, VectorXd::Zero(1), MatrixXd::Ones(1, 1), record);
  EXPECT_NEAR(estimate.state[0], (1.0 + 8.0 + 1.0) / 5.25, 1e-14);
  EXPECT_NEAR(estimate.covariance(0, 0), 1.0 / 5.25, 1e-14);
}

TEST(BatchEstimator, SaysWhatTheRecordDoesNotDetermine) {
  // At rest nothing depends on K and C.
  const filters::Measurements record = motion(Eigen::Vector4d(0, 0, stiffness, 1.2), stamps(200, 4e-3));
  const BatchEstimate estimate = estimate_batch(*oscillator(4e-3, 1e-4), Eigen::Vector4d(0, 0, 400.0, 2.0),
                                                MatrixXd::Identity(4, 4), record);
  EXPECT_EQ(estimate.status, BatchStatus::undetermined);
  EXPECT_EQ(estimate.covariance.size(), 0);
  EXPECT_EQ(estimate.state[2], 400.0);
  EXPECT_FALSE(estimate.reason.empty());
}

TEST(BatchEstimator, FailsWithAReasonWhereTheMotionLeavesTheNumbers) {
  const filters::Measurements record = motion(Eigen::Vector4d(0.012, 0, stiffness, 1.2), stamps(2000, 1.0));
  const BatchEstimate estimate = estimate_batch(
      *oscillator(1.0, 1e-4), Eigen::Vector4d(0.012, 0, stiffness, -90.0), MatrixXd::Identity(4, 4), record);
  EXPECT_EQ(estimate.status, BatchStatus::failed);
  EXPECT_NE(estimate.reason.find("not finite"), std::string::npos) << estimate.reason;
}

TEST(BatchEstimator, RefusesWhatDoesNotFit) {
  const auto model = oscillator(4e-3, 1e-4);
  const VectorXd guess = Eigen::Vector4d(0.012, 0.0, stiffness, 1.2);
  const MatrixXd all = MatrixXd::Identity(4, 4);
  const filters::Measurements record = motion(guess, stamps(20, 4e-3));
  EXPECT_THROW(estimate_batch(*model, guess.head(3), all, record), std::invalid_argument);
  EXPECT_THROW(estimate_batch(*model, guess, all.topRows(3), record), std::invalid_argument);
  EXPECT_THROW(estimate_batch(*model, guess, all, record, {.prior_factor = MatrixXd::Ones(1, 3)}),
               std::invalid_argument);
  EXPECT_THROW(estimate_batch(*model, guess, all, record, {.max_iterations = 0}), std::invalid_argument);
  EXPECT_THROW(estimate_batch(*oscillator(4e-3, 0.0), guess, all, record), std::invalid_argument);
  filters::Measurements backwards = record;
  backwards.time.reverseInPlace();
  EXPECT_THROW(estimate_batch(*model, guess, all, backwards), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::batch_estimator_test
