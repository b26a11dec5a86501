// Conformance of smoothers. Oracles: batch least squares of the whole trajectory, the batch estimator, the
// smoothed shortened record. To be included by one file of a test program, which says what it runs on, in
// namespace beamid::test:
//
//     INSTANTIATE_TEST_SUITE_P(Mine, EverySmoother, testing::Values("my_smoother"), by_name);
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "beamid/testing/linear_model.hpp"
#include "beamid/testing/named.hpp"
#include "beamid/testing/oscillator.hpp"
#include "filters/batch_estimator.hpp"
#include "filters/smoother.hpp"

namespace beamid::test {

/// The suite, on a registered name.
class EverySmoother : public testing::TestWithParam<std::string> {
 protected:
  Eigen::MatrixXd gaussian(Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal_(random_); });
  }
  double normal() { return normal_(random_); }

  std::mt19937 random_{21};

 private:
  std::normal_distribution<double> normal_;
};

namespace smoother_contracts {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::Gaussian, filters::Keep;

inline constexpr double missing = std::numeric_limits<double>::quiet_NaN();

inline filters::FilterRun filtered(const LinearModel& model, const Gaussian& initial,
                                   const filters::Measurements& record) {
  const auto filter = filters::filter_registry().make("ekf", {}, std::make_unique<LinearModel>(model));
  return filters::run(*filter, initial, record, Keep::all_estimates);
}

TEST_P(EverySmoother, IsLeastSquaresOfTheWholeTrajectoryOnLinearModels) {
  // Oracle: all z_k at once from prior, motion and measurements, one dense least-squares problem.
  for (int repeat = 0; repeat < 10; ++repeat) {
    const Index n = 1 + repeat % 4, p = 1 + repeat % 2, samples = 15;
    LinearModel model;
    model.a = 0.9 / std::sqrt(static_cast<double>(n)) * gaussian(n, n);
    model.c = gaussian(p, n);
    const MatrixXd q = gaussian(n, n) + 0.5 * MatrixXd::Identity(n, n), r = gaussian(p, p);
    model.q = q * q.transpose();
    model.r = r * r.transpose() + 0.1 * MatrixXd::Identity(p, p);
    filters::Measurements record{
        VectorXd::LinSpaced(samples, 0, static_cast<double>(samples - 1)), gaussian(p, samples), {}};
    record.outputs.col(4).setConstant(missing);

    MatrixXd rows = MatrixXd::Zero(n * samples + p * samples, n * samples);
    VectorXd right = VectorXd::Zero(rows.rows());
    const MatrixXd by_q = MatrixXd(model.q.llt().matrixL()).inverse();
    const MatrixXd by_r = MatrixXd(model.r.llt().matrixL()).inverse();
    rows.topLeftCorner(n, n).setIdentity();
    for (Index k = 0; k < samples; ++k) {
      if (k > 0) {
        rows.block(n * k, n * k, n, n) = by_q;
        rows.block(n * k, n * (k - 1), n, n) = -by_q * model.a;
      }
      if (k == 4) continue;
      rows.block(n * samples + p * k, n * k, p, n) = by_r * model.c;
      right.segment(n * samples + p * k, p) = by_r * record.outputs.col(k);
    }
    const MatrixXd covariance = (rows.transpose() * rows).inverse();
    const VectorXd mean = rows.colPivHouseholderQr().solve(right);

    const filters::FilterRun run = filtered(model, {VectorXd::Zero(n), MatrixXd::Identity(n, n)}, record);
    const filters::SmoothedRun smoothed =
        filters::smooth(run, model, record, GetParam(), {}, filters::Smooth::states_and_noises);
    for (Index k = 0; k < samples; ++k) {
      const Gaussian& estimate = smoothed.estimates[static_cast<std::size_t>(k)];
      const MatrixXd block = covariance.block(n * k, n * k, n, n);
      EXPECT_LT((estimate.mean - mean.segment(n * k, n)).norm(), 1e-10 * (1.0 + mean.norm()));
      EXPECT_LT((estimate.covariance - block).norm(), 1e-10 * block.norm());
      if (k + 1 == samples) continue;
      MatrixXd motion = MatrixXd::Zero(n, n * samples);  // w_k = z_k+1 - A z_k
      motion.middleCols(n * k, n) = -model.a;
      motion.middleCols(n * (k + 1), n).setIdentity();
      const Gaussian& noise = smoothed.noises[static_cast<std::size_t>(k)];
      const MatrixXd spread = motion * covariance * motion.transpose();
      EXPECT_LT((noise.mean - motion * mean).norm(), 1e-10 * (1.0 + mean.norm()));
      EXPECT_LT((noise.covariance - spread).norm(), 1e-10 * (1.0 + spread.norm()));
    }
  }
}

TEST_P(EverySmoother, OfAFixedLagIsThatOfTheShortenedRecord) {
  LinearModel model;
  model.a = 0.5 * gaussian(3, 3);
  model.c = gaussian(1, 3);
  model.q = MatrixXd::Identity(3, 3);
  model.r = MatrixXd::Identity(1, 1);
  const filters::Measurements record{VectorXd::LinSpaced(40, 0, 39), gaussian(1, 40), {}};
  const Gaussian initial{VectorXd::Zero(3), MatrixXd::Identity(3, 3)};
  const filters::FilterRun run = filtered(model, initial, record);
  const std::vector<Gaussian> lagged = filters::fixed_lag_smooth(run, model, record, 7, GetParam());
  ASSERT_EQ(lagged.size(), 40u);
  for (Index k = 0; k < 40; ++k) {
    const Index length = std::min<Index>(k + 8, 40);
    const filters::Measurements part{record.time.head(length), record.outputs.leftCols(length), {}};
    const filters::SmoothedRun smoothed =
        filters::smooth(filtered(model, initial, part), model, part, GetParam());
    const Gaussian& expected = smoothed.estimates[static_cast<std::size_t>(k)];
    EXPECT_EQ(lagged[static_cast<std::size_t>(k)].mean, expected.mean) << k;
    EXPECT_EQ(lagged[static_cast<std::size_t>(k)].covariance, expected.covariance) << k;
  }
}

TEST_P(EverySmoother, WorksWhereParametersAreKnownExactly) {
  // Oracle: the same without the parameter. No process noise, so every predicted covariance is singular.
  LinearModel whole, part;
  part.a = MatrixXd(2, 2), part.c = MatrixXd(1, 2), part.r = MatrixXd::Ones(1, 1);
  part.a << 1.0, 0.1, -0.2, 0.95;
  part.c << 1.0, 0.0;
  part.q = MatrixXd::Zero(2, 2);
  whole = part;
  whole.a = MatrixXd::Identity(3, 3);
  whole.a.topLeftCorner(2, 2) = part.a;
  whole.a(1, 2) = 0.3;
  whole.c = Eigen::RowVector3d(1.0, 0.0, 0.0);
  whole.q = MatrixXd::Zero(3, 3);
  filters::Measurements record{VectorXd::LinSpaced(30, 0, 29), gaussian(1, 30), {}};
  const Gaussian three{VectorXd::Zero(3), Eigen::Vector3d(1.0, 4.0, 0.0).asDiagonal()};
  const Gaussian two{VectorXd::Zero(2), Eigen::Vector2d(1.0, 4.0).asDiagonal()};
  const auto smoothed = filters::smooth(filtered(whole, three, record), whole, record, GetParam());
  const auto expected = filters::smooth(filtered(part, two, record), part, record, GetParam());
  for (std::size_t k = 0; k < 30; ++k) {
    EXPECT_LT((smoothed.estimates[k].mean.head(2) - expected.estimates[k].mean).norm(), 1e-12);
    EXPECT_LT((smoothed.estimates[k].marginal(0, 2) - expected.estimates[k].covariance).norm(), 1e-12);
    EXPECT_EQ(smoothed.estimates[k].covariance(2, 2), 0.0);
  }
}

TEST_P(EverySmoother, OfADeterministicMotionIsTheBatchEstimate) {
  // Oracle: maximum likelihood with the same prior, to the linearisation of the filter.
  const double dt = 4e-3, noise = 1e-4;
  const auto model = [&] {
    return filters::discretise(std::make_shared<Oscillator>(3.0), dt, "exponential",
                               {{}, MatrixXd::Constant(1, 1, noise * noise)});
  };
  const auto discrete = model();
  filters::Measurements record{VectorXd::LinSpaced(1000, 0.0, 999 * dt), MatrixXd(1, 1000), {}};
  VectorXd z = Eigen::Vector4d(0.012, 0.0, 515.8, 1.2), next;
  for (Index k = 0; k < 1000; ++k) {
    record.outputs(0, k) = z[0] + noise * normal();
    discrete->transition(z, {}, next);
    z.swap(next);
  }
  const Eigen::Vector4d mean(0.0122, 0.001, 514.0, 1.25), deviation(1e-3, 1e-2, 5.0, 0.1);
  const Gaussian initial{mean, deviation.cwiseAbs2().asDiagonal()};
  const auto filter = filters::filter_registry().make("ekf", {}, model());
  const filters::FilterRun run = filters::run(*filter, initial, record, Keep::all_estimates);
  const filters::SmoothedRun smoothed = filters::smooth(run, *discrete, record, GetParam());
  const filters::BatchEstimate batch =
      filters::estimate_batch(*discrete, mean, MatrixXd::Identity(4, 4), record,
                              {.prior_factor = deviation.cwiseInverse().asDiagonal()});
  const Gaussian& first = smoothed.estimates.front();
  for (Index i = 0; i < 4; ++i) {
    const double spread = std::sqrt(batch.covariance(i, i));
    EXPECT_NEAR((first.mean[i] - batch.state[i]) / spread, 0.0, 0.05) << i;
    EXPECT_NEAR(first.deviations()[i] / spread, 1.0, 0.02) << i;
  }
  EXPECT_NEAR(first.mean[2] / run.last.mean[2], 1.0, 1e-10);  // constant: smoothed as at the end
}

TEST_P(EverySmoother, KeepsFactorsForStatesThatAreCarriedByFactors) {
  // Oracle: the same estimates as matrices.
  LinearModel model;
  model.a = 0.4 * gaussian(5, 5);
  model.c = gaussian(1, 5);
  model.q = MatrixXd::Zero(5, 5);
  model.r = MatrixXd::Identity(1, 1);
  const MatrixXd factor = gaussian(5, 2);
  const filters::Measurements record{VectorXd::LinSpaced(8, 0, 7), gaussian(1, 8), {}};
  const auto filter =
      filters::filter_registry().make("low_rank_ekf", {}, std::make_unique<LinearModel>(model));
  const auto low_rank = filters::run(*filter, {VectorXd::Zero(5), {}, factor}, record, Keep::all_estimates);
  const auto smoothed = filters::smooth(low_rank, model, record, GetParam());
  const auto expected = filters::smooth(
      filtered(model, {VectorXd::Zero(5), factor * factor.transpose()}, record), model, record, GetParam());
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_EQ(smoothed.estimates[k].covariance.size(), 0);
    EXPECT_LE(smoothed.estimates[k].factor.cols(), 2);
    const MatrixXd& covariance = expected.estimates[k].covariance;
    EXPECT_LT((smoothed.estimates[k].mean - expected.estimates[k].mean).norm(), 1e-7);
    EXPECT_LT((smoothed.estimates[k].marginal(0, 5) - covariance).norm(), 1e-7 * covariance.norm());
  }
}

TEST_P(EverySmoother, RefusesRunsWithoutEstimatesAndOfOtherRecords) {
  LinearModel model;
  model.a = model.c = model.q = model.r = MatrixXd::Ones(1, 1);
  const filters::Measurements record{VectorXd::LinSpaced(8, 0, 7), gaussian(1, 8), {}};
  const Gaussian initial{VectorXd::Zero(1), MatrixXd::Ones(1, 1)};
  const filters::FilterRun run = filtered(model, initial, record);
  const filters::Measurements other{record.time.head(5), record.outputs.leftCols(5), {}};
  EXPECT_THROW(filters::smooth({}, model, record, GetParam()), std::invalid_argument);
  EXPECT_THROW(filters::smooth(run, model, other, GetParam()), std::invalid_argument);
  EXPECT_THROW(filters::smooth(run, model, record, "no_such_smoother"), std::invalid_argument);
  EXPECT_THROW(filters::fixed_lag_smooth(run, model, record, -1, GetParam()), std::invalid_argument);
}

TEST_P(EverySmoother, DescribesItselfAndItsOptions) {
  expect_described(filters::smoother_registry().find(GetParam()));
}

}  // namespace smoother_contracts
}  // namespace beamid::test
