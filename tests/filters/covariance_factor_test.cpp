#include "filters/covariance_factor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "filters/filter.hpp"

namespace beamid::covariance_factor_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

MatrixXd random(Index rows, Index columns, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(generator); });
}

// In units of the deviations. Oracle: the covariance itself.
double distance(const MatrixXd& factor, const MatrixXd& covariance) {
  const VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  return (scale.asDiagonal() * (factor * factor.transpose() - covariance) * scale.asDiagonal()).norm();
}

TEST(CovarianceFactor, IsOfEveryRankWhateverEntriesDependOnWhich) {
  for (const Index n : {2, 5, 12})
    for (Index rank = 1; rank <= n; ++rank)
      for (unsigned seed = 0; seed < 20; ++seed) {
        const VectorXd units = random(n, 1, 100 + seed).array().exp().pow(4);
        const MatrixXd root = units.asDiagonal() * random(n, rank, seed);
        const MatrixXd covariance = root * root.transpose(), factor = filters::factor_of(covariance);
        EXPECT_GE(factor.cols(), rank) << "of " << n << ", seed " << seed;
        EXPECT_LE(factor.cols(), std::min(n, rank + 1))
            << "of " << n << ", seed " << seed;  // rounding may count as one
        EXPECT_LT(distance(factor, covariance), 1e-12) << "of " << n << ", seed " << seed;
      }
}

// An integral and its rate after one step: entry 1 is entry 0, and what stands behind them is of its own.
TEST(CovarianceFactor, KeepsWhatStandsBehindADependentEntry) {
  MatrixXd covariance = MatrixXd::Identity(5, 5);
  covariance(0, 1) = covariance(1, 0) = 1.0;
  const MatrixXd factor = filters::factor_of(covariance);
  EXPECT_EQ(factor.cols(), 4);
  EXPECT_LT(distance(factor, covariance), 1e-15);
}

TEST(CovarianceFactor, HasNoRowsForEntriesThatAreCertain) {
  const MatrixXd factor = filters::factor_of(MatrixXd(Eigen::Vector3d(4.0, 0.0, 9.0).asDiagonal()));
  EXPECT_EQ(factor.cols(), 2);
  EXPECT_TRUE(factor.row(1).isZero(0.0));
}

TEST(CovarianceFactor, RefusesWhatIsNone) {
  MatrixXd covariance = MatrixXd::Constant(3, 3, 1.0);
  covariance(1, 2) = covariance(2, 1) = 0.9;  // as entries 1 and 2 are both entry 0
  EXPECT_THROW(filters::factor_of(covariance), filters::FilterFailure);
  covariance(1, 2) = covariance(2, 1) = std::nan("");
  EXPECT_THROW(filters::factor_of(covariance), filters::FilterFailure);
}

}  // namespace
}  // namespace beamid::covariance_factor_test
