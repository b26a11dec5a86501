// The linear algebra of an implicit step against dense Eigen.
#include "fem/response/symmetric_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace beamid::symmetric_factor_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

MatrixXd random_band(int n, int width, std::mt19937& random) {
  std::uniform_real_distribution<double> entry(-1.0, 1.0);
  MatrixXd a = MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = std::max(0, i - width); j < i; ++j) a(i, j) = a(j, i) = entry(random);
    a(i, i) = 3.0 + 2.0 * width;
  }
  return a;
}

TEST(SymmetricFactor, SolvesBandsOfEveryWidthAndSize) {
  std::mt19937 random(7);
  for (int width = 0; width <= 10; ++width)
    for (int n = 1; n < 40; ++n) {
      const MatrixXd a = random_band(n, width, random);
      const VectorXd b = VectorXd::LinSpaced(n, -1.0, 2.0);
      VectorXd x = b;
      fem::SymmetricFactor(a.sparseView(), "a").solve_in_place(x);
      ASSERT_LT((a * x - b).norm(), 1e-14 * b.norm()) << width << " of " << n;
    }
}

TEST(SymmetricFactor, RefusesAnIndefiniteMatrixWhereverThePivotIs) {
  std::mt19937 random(7);
  for (const int width : {2, 6, 12})
    for (const int at : {0, 9, 15, 20, 29}) {
      MatrixXd a = random_band(30, width, random);
      a(at, at) = -1.0;
      EXPECT_THROW(fem::SymmetricFactor(a.sparseView(), "a"), std::runtime_error) << width << " " << at;
    }
}

TEST(DiagonalProduct, IsTheProductForBandsAndForScatteredEntries) {
  std::mt19937 random(7);
  MatrixXd scattered = MatrixXd::Zero(30, 40);
  for (int i = 0; i < 25; ++i) scattered(int(random() % 30), int(random() % 40)) = 1.0 + i;
  const VectorXd x = VectorXd::LinSpaced(30, 1.0, 2.0), longer = VectorXd::LinSpaced(40, 1.0, 2.0);
  for (const auto& [a, v] : {std::pair(random_band(30, 3, random), x), std::pair(scattered, longer)}) {
    VectorXd y = VectorXd::Ones(30);
    const fem::DiagonalProduct product{fem::SparseMatrix(a.sparseView())};
    product.add(v, y);
    EXPECT_LT((y - VectorXd::Ones(30) - a * v).norm(), 1e-13 * (a * v).norm());
    product.subtract(v, y);
    EXPECT_LT((y - VectorXd::Ones(30)).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace beamid::symmetric_factor_test
