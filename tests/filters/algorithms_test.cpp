// One algorithm text: what sizes known to the compiler make faster must not become another filter.
#include <gtest/gtest.h>

#include <random>

#include "beamid/testing/oscillator.hpp"
#include "filters/algorithms/extended_kalman.hpp"
#include "filters/algorithms/oscillator.hpp"
#include "filters/algorithms/square_root_kalman.hpp"
#include "filters/algorithms/unscented_kalman.hpp"
#include "filters/filter_run.hpp"

namespace beamid::algorithms_test {
namespace {

using Eigen::Matrix2d, Eigen::Matrix4d, Eigen::MatrixXd, Eigen::Vector2d, Eigen::Vector4d, Eigen::VectorXd;
using filters::Quantity;
using namespace filters::algorithms;

constexpr double mass = 3.0, dt = 1e-3;
const Vector4d start(0.012, 0.0, 450.0, 3.0), variance(1e-8, 1e-6, 1e4, 4.0);
const Matrix4d process = Vector4d(1e-16, 1e-14, 1e-6, 1e-8).asDiagonal();
const Matrix2d noise = (Matrix2d() << 1e-8, 3e-8, 3e-8, 1e-6).finished();

Oscillator<double, 2> model() {
  return {mass, dt, {Quantity::displacement, Quantity::velocity}, process, noise};
}

filters::Measurements noisy_decay(Eigen::Index samples) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  filters::Measurements record{
      VectorXd::LinSpaced(samples, 0.0, dt * static_cast<double>(samples - 1)), MatrixXd(2, samples), {}};
  Vector4d z(0.012, 0.0, 515.8, 7.867), next;
  for (Eigen::Index k = 0; k < samples; ++k) {
    record.outputs.col(k) << z[0] + 1e-4 * normal(random), z[1] + 1e-3 * normal(random);
    model().transition(z, next);
    z = next;
  }
  return record;
}

filters::FilterRun registered(const char* name, const filters::Measurements& record) {
  const auto filter = filters::filter_registry().make(
      name, {},
      filters::discretise(std::make_shared<test::Oscillator>(mass, 2), dt, "exponential", {process, noise}));
  return run(*filter, {start, variance.asDiagonal()}, record);
}

template <class Algorithm>
void step_through(Algorithm& algorithm, const filters::Measurements& record) {
  const auto at_step = model();
  for (Eigen::Index k = 0; k < record.time.size(); ++k) {
    if (k > 0) algorithm.predict(at_step);
    algorithm.look(at_step, Vector2d(record.outputs.col(k)));
    algorithm.update(at_step);
  }
}

// In units of the deviations, which span eight decades.
void expect_same(const Vector4d& mean, const Matrix4d& covariance, const filters::Gaussian& expected) {
  const VectorXd scale = expected.deviations().cwiseInverse();
  EXPECT_LT(scale.cwiseProduct(mean - expected.mean).norm(), 1e-9);
  EXPECT_LT((scale.asDiagonal() * (covariance - expected.covariance) * scale.asDiagonal()).norm(), 1e-9);
}

// Oracle of the next three: the registered filter, sizes known at run time, on the general scheme.
TEST(Algorithms, ExtendedFilterOfFixedSizeIsTheRegisteredOne) {
  const auto record = noisy_decay(2000);
  ExtendedKalman<double, 4, 2> filter;
  filter.mean = start;
  filter.covariance = variance.asDiagonal();
  step_through(filter, record);
  expect_same(filter.mean, filter.covariance, registered("ekf", record).last);
}

TEST(Algorithms, UnscentedFilterOfFixedSizeIsTheRegisteredOne) {
  const auto record = noisy_decay(2000);
  UnscentedKalman<double, 4, 2> filter(Spread{2.0, 1.0, true});  // alpha = 1, beta = 2, kappa = 0
  filter.mean = start;
  filter.covariance = variance.asDiagonal();
  step_through(filter, record);
  expect_same(filter.mean, filter.covariance, registered("ukf", record).last);
}

TEST(Algorithms, SquareRootFilterOfFixedSizeIsTheRegisteredOne) {
  const auto record = noisy_decay(2000);
  SquareRootKalman<double, 4, 2> filter(Spread{2.0, 1.0, true});
  filter.mean = start;
  filter.root = variance.cwiseSqrt().asDiagonal();
  step_through(filter, record);
  expect_same(filter.mean, filter.root * filter.root.transpose(), registered("srukf", record).last);
}

TEST(LowerRoot, LeavesOutWhatIsKnownExactlyAndRefusesWhatIsNegative) {
  Eigen::Matrix3d known, root;
  known << 4.0, 0.0, 2.0, 0.0, 0.0, 0.0, 2.0, 0.0, 5.0;
  lower_root(known, root);
  EXPECT_LT((root * root.transpose() - known).norm(), 1e-15);
  known(1, 1) = -0.1;
  EXPECT_THROW(lower_root(known, root), filters::FilterFailure);
}

TEST(Triangularise, KeepsTheCovarianceOfAFactorOfAnyShape) {
  // Oracle: F F^T itself. Columns far apart in size, one of them empty.
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (const Eigen::Index columns : {3, 4, 11}) {
    MatrixXd factor = MatrixXd::NullaryExpr(3, columns, [&] { return normal(random); });
    factor.row(1) *= 1e-6;
    factor.col(1).setZero();
    MatrixXd array = factor.transpose(), root;
    triangularise(array, root);
    EXPECT_TRUE(root.isLowerTriangular(0.0));
    EXPECT_GE(root.diagonal().minCoeff(), 0.0);
    const VectorXd scale = factor.rowwise().norm().cwiseInverse();
    const MatrixXd error = root * root.transpose() - factor * factor.transpose();
    EXPECT_LT((scale.asDiagonal() * error * scale.asDiagonal()).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace beamid::algorithms_test
