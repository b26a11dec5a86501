// The UKF in the factor's space against the UKF on the matrix and the Kalman filter.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <random>

#include "beamid/testing/linear_model.hpp"
#include "beamid/testing/oscillator.hpp"
#include "filters/filter_run.hpp"

namespace beamid::low_rank_ukf_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::filter_registry, filters::Gaussian;

filters::FilterRun run_of(const std::string& filter, std::unique_ptr<filters::DiscreteModel> model,
                          const Gaussian& initial, const filters::Measurements& record,
                          const filters::Options& options = {}) {
  const auto made = filter_registry().make(filter, options, std::move(model));
  return run(*made, initial, record);
}

std::unique_ptr<filters::DiscreteModel> oscillator(double noise) {
  return filters::discretise(std::make_shared<test::Oscillator>(3.0), 5e-3, "exponential",
                             {{}, MatrixXd::Constant(1, 1, noise * noise)});
}

// A linear model of `n` states of which few are uncertain at first.
struct Linear {
  test::LinearModel model;
  Gaussian initial;
  filters::Measurements record;
};

Linear linear(Index n, Index rank, double process) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  const auto gaussian = [&](Index rows, Index columns) {
    return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); }).eval();
  };
  Linear made;
  made.model.a = 0.95 * MatrixXd(Eigen::HouseholderQR<MatrixXd>(gaussian(n, n)).householderQ());
  made.model.c = gaussian(2, n);
  if (process > 0.0) made.model.q = process * MatrixXd::Identity(n, n);
  made.model.r = MatrixXd::Identity(2, 2);
  made.initial = {VectorXd::Zero(n), {}, gaussian(n, rank)};
  made.record = {VectorXd::LinSpaced(60, 0, 1), gaussian(2, 60), {}};
  return made;
}

TEST(LowRankUkf, IsTheKalmanFilterOnLinearModelsOfLowRank) {
  // Oracle: the EKF on the singular matrix: on linear models the Kalman filter. 100 states, 3 directions.
  const Linear made = linear(100, 3, 0.0);
  const auto expected =
      run_of("ekf", std::make_unique<test::LinearModel>(made.model), made.initial, made.record);
  for (const double alpha : {1.0, 1e-2}) {
    const auto found = run_of("low_rank_ukf", std::make_unique<test::LinearModel>(made.model), made.initial,
                              made.record, {{"alpha", alpha}});
    EXPECT_EQ(found.last.factor.cols(), 3);
    EXPECT_TRUE(found.remarks.empty());
    EXPECT_LT((found.last.mean - expected.last.mean).norm(), 1e-11) << alpha;
    EXPECT_LT((found.last.marginal(0, 100) - expected.last.covariance).norm(), 1e-11) << alpha;
  }
}

TEST(LowRankUkf, IsTheDenseUkfWhereNoRankIsCut) {
  // Oracle: the UKF on the matrix with the same spread: its points are the columns of the Cholesky factor,
  // and so are these. The prior is so wide that the filters' curvature shows.
  const double noise = 1e-3;
  const auto model = oscillator(1.0);
  filters::Measurements record{VectorXd::LinSpaced(400, 0, 2), MatrixXd(1, 400), {}};
  VectorXd z = Eigen::Vector4d(0.012, 0.0, 515.8, 7.9), next;
  for (Index k = 0; k < 400; ++k) {
    record.outputs(0, k) = z[0];
    model->transition(z, {}, next);
    z.swap(next);
  }
  const Eigen::Vector4d mean(0.011, 0.01, 450.0, 12.0), variance(1e-5, 1e-3, 1e4, 25.0);
  const Gaussian initial{mean, variance.asDiagonal()};
  const auto ekf = run_of("ekf", oscillator(noise), initial, record);
  for (const double alpha : {1.0, 0.3}) {
    const auto dense = run_of("ukf", oscillator(noise), initial, record, {{"alpha", alpha}});
    const auto factor = run_of("low_rank_ukf", oscillator(noise), initial, record, {{"alpha", alpha}});
    const VectorXd deviation = dense.last.deviations();
    EXPECT_LT((factor.last.mean - dense.last.mean).cwiseQuotient(deviation).norm(), 1e-8) << alpha;
    EXPECT_LT((factor.last.deviations() - deviation).cwiseQuotient(deviation).norm(), 1e-8) << alpha;
    EXPECT_GT((ekf.last.mean - dense.last.mean).cwiseQuotient(deviation).norm(), 1e-3);  // it is another one
  }
}

TEST(LowRankUkf, SaysWhatCuttingTheRankDropped) {
  // Oracle: with 100 states of which 3 directions are uncertain, noise on all of them cannot be kept.
  const Linear made = linear(100, 3, 0.01);
  const auto found =
      run_of("low_rank_ukf", std::make_unique<test::LinearModel>(made.model), made.initial, made.record);
  const auto kept = run_of("low_rank_ukf", std::make_unique<test::LinearModel>(made.model), made.initial,
                           made.record, {{"rank", 100.0}});
  const auto expected =
      run_of("ekf", std::make_unique<test::LinearModel>(made.model), made.initial, made.record);
  EXPECT_EQ(found.last.factor.cols(), 3);
  ASSERT_EQ(found.remarks.size(), 1u);
  EXPECT_NE(found.remarks[0].find("rank 3"), std::string::npos);
  EXPECT_TRUE(kept.remarks.empty());
  EXPECT_LT((kept.last.marginal(0, 100) - expected.last.covariance).norm(), 1e-10);
}

TEST(LowRankUkf, RefusesSpreadsThatBreakPositivity) {
  const auto make = [](const filters::Options& options) {
    return filter_registry().make("low_rank_ukf", options, oscillator(1.0));
  };
  EXPECT_THROW(make({{"alpha", 0.0}}), std::invalid_argument);
  EXPECT_THROW(make({{"kappa", -1.0}}), std::invalid_argument);
  EXPECT_THROW(make({{"alpha", 2.0}}), std::invalid_argument);  // beta = 2 < alpha^2
  EXPECT_THROW(make({{"alpha", 1e-6}}), std::invalid_argument);
  EXPECT_THROW(make({{"rank", -1.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::low_rank_ukf_test
