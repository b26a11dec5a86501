// Kalman filter and smoother of linear models in matrices.
#include "filters/linear_gaussian.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>

#include "filters/innovation_likelihood.hpp"

namespace beamid::linear_gaussian_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Two states, two outputs, one input that moves and shows.
filters::LinearGaussian some_model() {
  filters::LinearGaussian model;
  model.a = (MatrixXd(2, 2) << 0.95, 0.3, -0.25, 0.9).finished();
  model.g = (MatrixXd(2, 1) << 0.1, 0.4).finished();
  model.h = (MatrixXd(2, 2) << 1.0, 0.0, 0.5, -1.0).finished();
  model.d = (MatrixXd(2, 1) << 0.0, 0.7).finished();
  model.q = (MatrixXd(2, 2) << 0.02, 0.01, 0.01, 0.05).finished();
  model.r = (MatrixXd(2, 2) << 0.04, 0.0, 0.0, 0.09).finished();
  model.start = {Eigen::Vector2d(0.3, -0.1), (MatrixXd(2, 2) << 1.0, 0.2, 0.2, 0.5).finished(), {}};
  return model;
}

filters::Measurements some_record(Index samples) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  filters::Measurements record{VectorXd::LinSpaced(samples, 0.0, static_cast<double>(samples - 1)),
                               MatrixXd(2, samples), MatrixXd(1, samples)};
  for (double& value : record.outputs.reshaped()) value = normal(random);
  for (double& value : record.inputs.reshaped()) value = normal(random);
  return record;
}

// Means and covariance of all states (2 N), conditioned on the readings that are there; and the density of
// these, -ln.
struct Dense {
  VectorXd mean;
  MatrixXd covariance;
  double cost = 0.0;
};

Dense all_at_once(const filters::LinearGaussian& model, const filters::Measurements& record) {
  const Index n = record.size();
  VectorXd mean(2 * n);
  MatrixXd covariance(2 * n, 2 * n);
  mean.head(2) = model.start.mean;
  covariance.topLeftCorner(2, 2) = model.start.covariance;
  for (Index k = 1; k < n; ++k) {
    mean.segment(2 * k, 2) = model.a * mean.segment(2 * k - 2, 2) + model.g * record.inputs.col(k - 1);
    covariance.block(2 * k, 0, 2, 2 * k) = model.a * covariance.block(2 * k - 2, 0, 2, 2 * k);
    covariance.block(0, 2 * k, 2 * k, 2) = covariance.block(2 * k, 0, 2, 2 * k).transpose();
    covariance.block(2 * k, 2 * k, 2, 2) =
        model.a * covariance.block(2 * k - 2, 2 * k - 2, 2, 2) * model.a.transpose() + model.q;
  }
  std::vector<std::pair<Index, Index>> read;
  for (Index k = 0; k < n; ++k)
    for (Index i = 0; i < 2; ++i)
      if (std::isfinite(record.outputs(i, k))) read.emplace_back(i, k);
  const auto p = static_cast<Index>(read.size());
  MatrixXd h = MatrixXd::Zero(p, 2 * n), r = MatrixXd::Zero(p, p);
  VectorXd rest(p);
  for (Index j = 0; j < p; ++j) {
    const auto [i, k] = read[static_cast<std::size_t>(j)];
    h.block(j, 2 * k, 1, 2) = model.h.row(i);
    r(j, j) = model.r(i, i);
    rest[j] = record.outputs(i, k) - model.d(i, 0) * record.inputs(0, k);
  }
  rest -= h * mean;
  const Eigen::LLT<MatrixXd> factor(h * covariance * h.transpose() + r);
  const MatrixXd gain = factor.solve(h * covariance).transpose();
  return {mean + gain * rest, covariance - gain * h * covariance,
          0.5 * rest.dot(factor.solve(rest)) + MatrixXd(factor.matrixL()).diagonal().array().log().sum()};
}

// Oracle: a constant read N times has the deviation sigma / sqrt(N) at every sample; a known velocity changes
// nothing. As P - P W P the variance at the start would have four digits.
TEST(LinearGaussian, KeepsItsDigitsWhereTheStartIsPoorlyKnown) {
  filters::LinearGaussian model = some_model();
  model.a = (MatrixXd(2, 2) << 1.0, 1.0, 0.0, 1.0).finished();
  model.q.setZero();
  model.h = (MatrixXd(2, 2) << 1.0, 0.0, 1.0, 0.0).finished();
  model.r = (MatrixXd(2, 2) << 2e-6, 0.0, 0.0, 2e-6).finished();
  model.start.covariance = (MatrixXd(2, 2) << 1e4, 0.0, 0.0, 0.0).finished();
  const filters::Measurements record = some_record(40);
  const filters::KalmanPass pass = filters::kalman_pass(model, record, 1.0);
  const MatrixXd deviations =
      filters::smoothed_rows(model, record, pass, MatrixXd::Identity(2, 2), MatrixXd()).deviations;
  for (Index k = 0; k < record.size(); ++k) {
    EXPECT_NEAR(deviations(0, k), 1e-3 / std::sqrt(40.0), 1e-3 * 1e-9) << k;
    EXPECT_EQ(deviations(1, k), 0.0) << k;
  }
}

TEST(LinearGaussian, IsTheJointGaussianOfAllStatesAndReadings) {
  // Oracle: the dense covariance of all states and readings. 300 samples: the gain has settled by then; the
  // gaps unsettle it.
  const filters::LinearGaussian model = some_model();
  filters::Measurements record = some_record(300);
  record.outputs(0, 150) = record.outputs(1, 150) = record.outputs(1, 220) =
      std::numeric_limits<double>::quiet_NaN();
  const filters::KalmanPass pass = filters::kalman_pass(model, record, 1.0);
  const Dense dense = all_at_once(model, record);
  EXPECT_NEAR(pass.cost, dense.cost, 1e-9 * std::abs(dense.cost));
  EXPECT_LT(pass.steps.size(), 250U);

  const MatrixXd rows = (MatrixXd(3, 2) << 1.0, 0.0, 0.0, 1.0, 2.0, -1.0).finished();
  const MatrixXd feed = (MatrixXd(3, 1) << 0.0, 0.0, 0.5).finished();
  const filters::SmoothedRows found = filters::smoothed_rows(model, record, pass, rows, feed);
  for (Index k = 0; k < record.size(); ++k) {
    const VectorXd mean = rows * dense.mean.segment(2 * k, 2) + feed * record.inputs.col(k);
    const VectorXd deviation =
        (rows * dense.covariance.block(2 * k, 2 * k, 2, 2) * rows.transpose()).diagonal().cwiseSqrt();
    ASSERT_NEAR((found.means.col(k) - mean).norm(), 0.0, 1e-9) << k;
    ASSERT_NEAR((found.deviations.col(k) - deviation).norm(), 0.0, 1e-9) << k;
  }
}

TEST(LinearGaussian, TakesAnotherRecordThroughTheSameSteps) {
  // Oracle: the dense covariance again, of other readings with the same gaps.
  const filters::LinearGaussian model = some_model();
  filters::Measurements record = some_record(120);
  record.outputs(0, 50) = record.outputs(1, 50) = record.outputs(1, 70) =
      std::numeric_limits<double>::quiet_NaN();
  filters::Measurements other = record;
  other.outputs = (0.5 - 3.0 * record.outputs.array()).matrix();
  other.inputs *= -2.0;
  const filters::KalmanPass pass =
      filters::kalman_pass(model, other, filters::kalman_pass(model, record, 1.0));
  const Dense dense = all_at_once(model, other);
  EXPECT_NEAR(pass.cost, dense.cost, 1e-9 * std::abs(dense.cost));
  const MatrixXd rows = MatrixXd::Identity(2, 2);
  const MatrixXd means = filters::smoothed_means(model, other, pass, rows, {});
  EXPECT_LT((means.reshaped() - dense.mean).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(LinearGaussian, RefusesUnevenStamps) {
  filters::Measurements record = some_record(20);
  record.time[7] += 0.1;
  EXPECT_THROW(filters::kalman_pass(some_model(), record, 1.0), std::invalid_argument);
}

TEST(LinearGaussian, SaysWhereAnInnovationHasNoVariance) {
  filters::LinearGaussian model = some_model();
  model.r(0, 0) = -5.0;
  EXPECT_THROW(filters::kalman_pass(model, some_record(20), 1.0), std::runtime_error);
}

TEST(InnovationPasses, AreThoseOfEveryModelAlone) {
  // Oracle: kalman_pass(). Seven models, so that a group of lanes is not full; gaps in one output and in
  // both; correlated noise; one model whose gain never settles, since nothing moves its state.
  filters::Measurements record = some_record(300);
  record.outputs(0, 150) = record.outputs(1, 150) = record.outputs(1, 220) = record.outputs(0, 0) =
      std::numeric_limits<double>::quiet_NaN();
  std::vector<filters::LinearGaussian> models(7, some_model());
  for (std::size_t i = 0; i < models.size(); ++i) {
    models[i].a *= 1.0 - 0.02 * static_cast<double>(i);
    models[i].r(0, 1) = models[i].r(1, 0) = 0.01 * static_cast<double>(i);
  }
  models[2].q.setZero(), models[2].a.setIdentity();
  const std::vector<filters::InnovationPass> passes = filters::innovation_passes(models, record, 1.0, true);
  for (std::size_t i = 0; i < models.size(); ++i) {
    const filters::KalmanPass alone = filters::kalman_pass(models[i], record, 1.0);
    ASSERT_FALSE(passes[i].failed);
    EXPECT_NEAR(passes[i].cost(), alone.cost, 1e-11 * std::abs(alone.cost)) << i;
    for (Index k = 0; k < record.size(); ++k) {
      const std::vector<Index>& seen = alone.step(k).seen;
      ASSERT_LT((passes[i].innovations(seen, k) - alone.innovations(seen, k)).norm(), 1e-11) << i << " " << k;
      ASSERT_LT((passes[i].covariance(k)(seen, seen) - alone.step(k).innovation_covariance).norm(), 1e-11)
          << i << " " << k;
      for (Index j = 0; j < 2; ++j)
        EXPECT_EQ(std::isnan(passes[i].innovations(j, k)), std::isnan(record.outputs(j, k)));
    }
  }
}

TEST(InnovationPasses, MarkTheModelThatFailsAlone) {
  std::vector<filters::LinearGaussian> models(4, some_model());
  models[1].r(0, 0) = -5.0;
  const auto passes = filters::innovation_passes(models, some_record(20), 1.0, false);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(passes[i].failed, i == 1) << i;
  EXPECT_NEAR(passes[0].cost(), filters::kalman_pass(models[0], some_record(20), 1.0).cost, 1e-10);
}

}  // namespace
}  // namespace beamid::linear_gaussian_test
