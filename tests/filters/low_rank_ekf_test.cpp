// The EKF on a factor against the EKF on the matrix.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <random>

#include "beamid/testing/linear_model.hpp"
#include "beamid/testing/oscillator.hpp"
#include "filters/filter_run.hpp"

namespace beamid::low_rank_ekf_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::filter_registry, filters::Gaussian;

std::unique_ptr<filters::DiscreteModel> oscillator(double noise, MatrixXd process = {}) {
  return filters::discretise(std::make_shared<test::Oscillator>(3.0), 1e-3, "exponential",
                             {std::move(process), MatrixXd::Constant(1, 1, noise * noise)});
}

filters::Measurements decay(const VectorXd& start, Index samples, double noise) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  const auto model = oscillator(1.0);
  filters::Measurements record{VectorXd(samples), MatrixXd(1, samples), {}};
  VectorXd z = start, next;
  for (Index k = 0; k < samples; ++k) {
    record.time[k] = 1e-3 * static_cast<double>(k);
    record.outputs(0, k) = z[0] + noise * normal(random);
    model->transition(z, {}, next);
    z.swap(next);
  }
  return record;
}

filters::FilterRun run_of(const std::string& filter, std::unique_ptr<filters::DiscreteModel> model,
                          const Gaussian& initial, const filters::Measurements& record,
                          const filters::Options& options = {}, const filters::Trace& trace = {}) {
  const auto made = filter_registry().make(filter, options, std::move(model));
  return run(*made, initial, record, filters::Keep::last_estimate, filters::Start::at_first_sample, trace);
}

// Largest difference of two estimates, in standard deviations.
double difference(const Gaussian& a, const Gaussian& b) {
  const VectorXd inverse = b.deviations().cwiseInverse();
  const Index n = b.mean.size();
  const MatrixXd covariance = a.marginal(0, n) - b.marginal(0, n);
  return std::max((a.mean - b.mean).cwiseProduct(inverse).cwiseAbs().maxCoeff(),
                  (inverse.asDiagonal() * covariance * inverse.asDiagonal()).cwiseAbs().maxCoeff());
}

TEST(LowRankEkf, EqualsTheDenseEkfAfter25000Steps) {
  // Oracle: the EKF on the matrix. Light damping, 25 s at 1 kHz, K and C 10 % and 50 % off; the factor's T
  // shrinks by five decades meanwhile. The tolerance is what rounding of the means amounts to beside bounds
  // of 1e-7 of their size.
  const double noise = 1e-5;
  const auto record = decay(Eigen::Vector4d(0.012, 0.0, 515.8, 0.17), 25000, noise);
  const Eigen::Vector4d mean(0.0118, 0.005, 470.0, 0.26), variance(1e-6, 1e-3, 3e3, 0.04);
  const Gaussian initial{mean, variance.asDiagonal()};
  const auto dense = run_of("ekf", oscillator(noise), initial, record);
  const auto factor = run_of("low_rank_ekf", oscillator(noise), initial, record);
  ASSERT_FALSE(dense.failure);
  ASSERT_FALSE(factor.failure);
  EXPECT_LT(difference(factor.last, dense.last), 1e-7);
  EXPECT_NEAR(factor.log_likelihood / dense.log_likelihood, 1.0, 1e-10);
  EXPECT_TRUE(factor.remarks.empty());
}

TEST(LowRankEkf, EqualsTheDenseEkfWhereTheInitialEstimateHasFewDirections) {
  // Oracle: the EKF on the singular matrix L L^T. Uncertain: one direction of the start, and K alone.
  const double noise = 1e-4;
  const auto record = decay(Eigen::Vector4d(0.012, 0.0, 515.8, 7.9), 3000, noise);
  MatrixXd factor(4, 2);
  factor << 1e-3, 0, 0.02, 0, 0, 30.0, 0, 0;
  const Eigen::Vector4d mean(0.0115, -0.01, 500.0, 7.9);
  const auto dense = run_of("ekf", oscillator(noise), {mean, factor * factor.transpose()}, record);
  const auto low_rank = run_of("low_rank_ekf", oscillator(noise), {mean, {}, factor}, record);
  EXPECT_EQ(low_rank.last.covariance.size(), 0);
  EXPECT_EQ(low_rank.last.factor.cols(), 2);
  EXPECT_LT((low_rank.last.mean - dense.last.mean).norm(), 1e-9 * dense.last.mean.norm());
  const MatrixXd covariance = low_rank.last.marginal(0, 4);
  EXPECT_LT((covariance - dense.last.covariance).norm(), 1e-8 * covariance.norm());
  EXPECT_EQ(low_rank.last.mean[3], 7.9);  // what is certain remains so
  EXPECT_EQ(covariance(3, 3), 0.0);
}

TEST(LowRankEkf, KeepsItsDigitsWhereDirectionsBecomeAlike) {
  // Oracle: the Kalman filter in long double. A saddle: one direction grows by e^30, the other shrinks as
  // much, so that all that was uncertain soon points the same way. Without rebasing the error is 6e-4.
  test::LinearModel model;
  model.a.resize(2, 2), model.c.resize(1, 2);
  const double dt = 1e-2;
  model.a << std::cosh(dt), std::sinh(dt), std::sinh(dt), std::cosh(dt);
  model.c << 1.0, 0.0;
  model.r = MatrixXd::Constant(1, 1, 1e-6);
  constexpr Index samples = 3000;
  const filters::Measurements record{VectorXd::LinSpaced(samples, 0, 30), MatrixXd::Zero(1, samples), {}};
  const auto found = run_of("low_rank_ekf", std::make_unique<test::LinearModel>(model),
                            {VectorXd::Zero(2), MatrixXd::Identity(2, 2)}, record);
  using Matrix = Eigen::Matrix<long double, 2, 2>;
  const Matrix a = model.a.cast<long double>();
  Matrix p = Matrix::Identity();
  for (Index k = 0; k < samples; ++k) {
    if (k > 0) p = (a * p * a.transpose()).eval();
    const Eigen::Matrix<long double, 2, 1> gain = p.col(0) / (p(0, 0) + 1e-6L);
    Matrix kept = Matrix::Identity();
    kept.col(0) -= gain;
    p = (kept * p * kept.transpose() + 1e-6L * gain * gain.transpose()).eval();
  }
  const Matrix error = found.last.covariance.cast<long double>() - p;
  EXPECT_LT(static_cast<double>(error.norm() / p.norm()), 1e-12);
}

TEST(LowRankEkf, TakesCorrelatedAndPerfectSensors) {
  // Oracle: the EKF on the matrix. Noise of two sensors that is correlated, and a third without any.
  test::LinearModel model;
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  const auto gaussian = [&](Index rows, Index columns) {
    return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); }).eval();
  };
  model.a = 0.4 * gaussian(5, 5);
  model.c = gaussian(3, 5);
  model.q = 0.1 * MatrixXd::Identity(5, 5);
  model.r = MatrixXd::Zero(3, 3);
  model.r.topLeftCorner(2, 2) << 1.0, 0.7, 0.7, 2.0;
  const filters::Measurements record{VectorXd::LinSpaced(50, 0, 1), gaussian(3, 50), {}};
  const Gaussian initial{VectorXd::Zero(5), MatrixXd::Identity(5, 5)};
  const auto dense = run_of("ekf", std::make_unique<test::LinearModel>(model), initial, record);
  const auto factor = run_of("low_rank_ekf", std::make_unique<test::LinearModel>(model), initial, record);
  ASSERT_FALSE(factor.failure) << factor.failure->reason;
  EXPECT_LT((factor.last.mean - dense.last.mean).norm(), 1e-12);
  EXPECT_LT((factor.last.covariance - dense.last.covariance).norm(), 1e-12);
  EXPECT_NEAR(factor.log_likelihood, dense.log_likelihood, 1e-9);
}

TEST(LowRankEkf, SaysWhatCuttingTheRankDropped) {
  // Oracle: the remark's own promise. Noise on K and C widens what was uncertain in two directions; with all
  // four kept nothing is dropped and the dense filter is met, with two the covariance is too small.
  const double noise = 1e-4;
  const Eigen::Vector4d mean(0.012, 0.0, 515.8, 7.9), process(0, 0, 1e-2, 1e-5);
  const auto record = decay(mean, 2000, noise);
  MatrixXd factor(4, 2);
  factor << 1e-3, 0, 0, 0.02, 0, 0, 0, 0;
  const Gaussian initial{mean, {}, factor};
  const MatrixXd q = process.asDiagonal();
  const auto dense = run_of("ekf", oscillator(noise, q), initial, record);
  const auto all = run_of("low_rank_ekf", oscillator(noise, q), initial, record);
  const auto cut = run_of("low_rank_ekf", oscillator(noise, q), initial, record, {{"rank", 2.0}});
  EXPECT_LT(difference(all.last, dense.last), 1e-8);
  EXPECT_TRUE(all.remarks.empty());
  ASSERT_EQ(cut.remarks.size(), 1u);
  EXPECT_NE(cut.remarks[0].find("rank 2 in 1999 steps"), std::string::npos) << cut.remarks[0];
  EXPECT_EQ(cut.last.factor.cols(), 2);
  EXPECT_LT(cut.last.deviations()[3], dense.last.deviations()[3]);
}

TEST(LowRankEkf, RefusesRanksThatAreNone) {
  for (const double rank : {-1.0, 2.5, std::nan(""), 1e300})
    EXPECT_THROW(filter_registry().make("low_rank_ekf", {{"rank", rank}}, oscillator(1.0)),
                 std::invalid_argument)
        << rank;
}

class FiltersOnFactors : public testing::TestWithParam<std::string> {};

TEST_P(FiltersOnFactors, StartFromAFactorAsFromItsCovariance) {
  // Oracle: the same filter from the covariance. The factor is a full one, and no triangle.
  const double noise = 1e-4;
  const auto record = decay(Eigen::Vector4d(0.012, 0.0, 515.8, 7.9), 500, noise);
  const Eigen::Vector4d mean(0.0115, -0.01, 500.0, 7.0), deviation(1e-3, 2e-2, 30.0, 2.0);
  const MatrixXd turn = Eigen::HouseholderQR<MatrixXd>(MatrixXd::Random(4, 4)).householderQ();
  const MatrixXd factor = deviation.asDiagonal() * turn, diagonal = deviation.cwiseAbs2().asDiagonal();
  const auto matrix = run_of(GetParam(), oscillator(noise), {mean, diagonal}, record);
  const auto from_factor = run_of(GetParam(), oscillator(noise), {mean, {}, factor}, record);
  // Other points of the same covariance see the curvature a little otherwise.
  EXPECT_LT(difference(from_factor.last, matrix.last), GetParam() == "low_rank_ukf" ? 1e-3 : 1e-7);
}

TEST_P(FiltersOnFactors, TraceWhatAnEstimateSays) {
  // Oracle: all estimates, kept.
  const double noise = 1e-4;
  const auto record = decay(Eigen::Vector4d(0.012, 0.0, 515.8, 7.9), 200, noise);
  const Eigen::Vector4d mean(0.0115, -0.01, 500.0, 7.0), variance(1e-6, 4e-4, 900.0, 4.0);
  const auto filter = filter_registry().make(GetParam(), {}, oscillator(noise));
  const auto result = run(*filter, {mean, variance.asDiagonal()}, record, filters::Keep::all_estimates,
                          filters::Start::at_first_sample, {{2, 0}});
  ASSERT_EQ(result.means.rows(), 2);
  ASSERT_EQ(result.means.cols(), 200);
  for (Index k = 0; k < 200; ++k) {
    const Gaussian& estimate = result.filtered[static_cast<std::size_t>(k)];
    EXPECT_EQ(result.means(0, k), estimate.mean[2]);
    EXPECT_NEAR(result.deviations(0, k) / estimate.deviations()[2], 1.0, 1e-12);
    EXPECT_NEAR(result.deviations(1, k) / estimate.deviations()[0], 1.0, 1e-12);
  }
  EXPECT_THROW(run(*filter, {mean, variance.asDiagonal()}, record, filters::Keep::last_estimate,
                   filters::Start::at_first_sample, {{4}}),
               std::invalid_argument);
}

TEST_P(FiltersOnFactors, RefuseFactorsThatDoNotFit) {
  const auto filter = filter_registry().make(GetParam(), {}, oscillator(1.0));
  EXPECT_THROW(filter->reset({VectorXd::Zero(4), {}, MatrixXd::Ones(3, 2)}), std::invalid_argument);
  EXPECT_THROW(filter->reset({VectorXd::Zero(4), {}, {}}), std::invalid_argument);
  EXPECT_THROW(filter->reset({VectorXd::Zero(4), MatrixXd::Identity(4, 4), 2 * MatrixXd::Identity(4, 4)}),
               std::invalid_argument);
  EXPECT_THROW(filter->reset({VectorXd::Zero(4), {}, MatrixXd::Constant(4, 1, std::nan(""))}),
               std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(All, FiltersOnFactors, testing::Values("ekf", "ukf", "low_rank_ekf", "low_rank_ukf"),
                         [](const auto& tested) { return tested.param; });

}  // namespace
}  // namespace beamid::low_rank_ekf_test
