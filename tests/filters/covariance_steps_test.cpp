// Products of covariances that leave out what is 0, or are never formed. Oracle: the dense products of the
// definition, on a random covariance.
#include "filters/algorithms/covariance_steps.hpp"

#include <gtest/gtest.h>

#include <random>

namespace beamid::covariance_steps_test {
namespace {

using Eigen::Index, Eigen::MatrixXd;
using Steps = filters::algorithms::CovarianceSteps<double, Eigen::Dynamic, Eigen::Dynamic>;

constexpr double rounding = 1e-14;

MatrixXd random(Index rows, Index columns, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(generator); });
}

MatrixXd covariance(Index n) {
  const MatrixXd root = random(n, n, 1);
  const MatrixXd square = root * root.transpose();
  return 0.5 * (square + square.transpose());
}

// Oscillators side by side, each moved by one unknown: 2 r + 1 states.
MatrixXd tangent_of_oscillators(Index r) {
  const Index n = 2 * r + 1;
  const MatrixXd entries = random(r, 6, 2);
  MatrixXd tangent = MatrixXd::Identity(n, n);
  for (Index i = 0; i < r; ++i) {
    tangent(i, i) = entries(i, 0), tangent(i, r + i) = entries(i, 1);
    tangent(r + i, i) = entries(i, 2), tangent(r + i, r + i) = entries(i, 3);
    tangent(i, n - 1) = entries(i, 4), tangent(r + i, n - 1) = entries(i, 5);
  }
  return tangent;
}

double distance(const MatrixXd& a, const MatrixXd& b) {
  return (a - b).norm() / b.norm();
}

TEST(CovarianceSteps, CarriesByTheEntriesOfATangentThatAreNotZero) {
  for (const Index oscillators : {2, 7, 8, 12, 40}) {
    const MatrixXd tangent = tangent_of_oscillators(oscillators), before = covariance(tangent.rows());
    MatrixXd after = before;
    Steps().carry(tangent, after);
    EXPECT_LT(distance(after, tangent * before * tangent.transpose()), rounding) << oscillators;
  }
}

TEST(CovarianceSteps, CarriesByAFullTangent) {
  for (const Index n : {4, 20}) {
    const MatrixXd tangent = random(n, n, 3), before = covariance(n);
    MatrixXd after = before;
    Steps().carry(tangent, after);
    EXPECT_LT(distance(after, tangent * before * tangent.transpose()), rounding) << n;
  }
}

TEST(CovarianceSteps, IsJosephsFormForAnyGain) {
  for (const Index n : {3, 20})
    for (const Index p : {1, 2, 5}) {
      const MatrixXd gain = random(n, p, 4), sensor = random(p, n, 5), noise = covariance(p);
      const MatrixXd kept = MatrixXd::Identity(n, n) - gain * sensor, before = covariance(n);
      MatrixXd after = before;
      Steps().reduce(gain, sensor, noise, after);
      const MatrixXd expected = kept * before * kept.transpose() + gain * noise * gain.transpose();
      EXPECT_LT(distance(after, expected), rounding) << n << " states, " << p << " outputs";
      EXPECT_EQ(after, after.transpose());
    }
}

TEST(NonZeros, MultiplyAsTheWholeMatrixDoes) {
  MatrixXd a = MatrixXd::Zero(5, 7);
  a(0, 6) = 2.0, a(4, 0) = -1.0, a(4, 3) = 0.5, a(2, 2) = 3.0;
  filters::NonZeros entries;
  ASSERT_TRUE(entries.take(a));
  const MatrixXd b = random(7, 3, 6);
  MatrixXd product;
  entries.from_left(b, product);
  EXPECT_LT(distance(product, a * b), rounding);
  entries.from_right(b.transpose(), product);
  EXPECT_LT(distance(product, b.transpose() * a.transpose()), rounding);
}

TEST(NonZeros, AreNotTakenOfAMatrixWithMoreThanAQuarter) {
  filters::NonZeros entries;
  MatrixXd a = MatrixXd::Identity(4, 4);
  EXPECT_TRUE(entries.take(a));
  a(0, 1) = 1.0;
  EXPECT_FALSE(entries.take(a));
}

}  // namespace
}  // namespace beamid::covariance_steps_test
