#include "experiments/signal/toolbox.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cstdlib>
#include <limits>

namespace beamid::experiments::least_squares_test {
namespace {

using Eigen::MatrixXcd, Eigen::MatrixXd;

// Oracle: the line 2 + 3 k through exact values, its columns 1e9 apart in size.
TEST(LeastSquares, SolvesColumnsOfAnyUnit) {
  MatrixXd a(4, 2), b(4, 1);
  for (int k = 0; k < 4; ++k) {
    a.row(k) << 1e6, 1e-3 * k;
    b(k) = 2 + 3 * k;
  }
  const MatrixXd x = least_squares(a, b);
  EXPECT_NEAR(x(0), 2e-6, 1e-18);
  EXPECT_NEAR(x(1), 3e3, 1e-9);
}

// Oracle: the factors of all rows at once. Many rows are taken in blocks.
TEST(LeastSquares, SolvesManyRowsAsFew) {
  std::srand(5);
  const MatrixXd a = MatrixXd::Random(20'000, 7), b = MatrixXd::Random(20'000, 2);
  const MatrixXd all = a.colPivHouseholderQr().solve(b);
  EXPECT_LT((least_squares(a, b) - all).norm(), 1e-13 * all.norm());
  const MatrixXcd z = MatrixXcd::Random(20'000, 3), y = MatrixXcd::Random(20'000, 1);
  const MatrixXcd whole = z.colPivHouseholderQr().solve(y);
  EXPECT_LT((complex_least_squares(z, y) - whole).norm(), 1e-13 * whole.norm());
  MatrixXd twice(20'000, 2);  // a column that repeats another
  twice << a.col(0), a.col(0);
  const MatrixXd shared = least_squares(twice, b);
  EXPECT_LT((twice * shared - a.col(0) * least_squares(a.leftCols(1), b)).norm(), 1e-10);
}

TEST(LeastSquares, HasAnAnswerWithoutColumnsAndRefusesWhatIsNotFinite) {
  EXPECT_EQ(least_squares(MatrixXd(5, 0), MatrixXd::Ones(5, 2)).rows(), 0);
  EXPECT_EQ(least_squares(MatrixXd(MatrixXd::Zero(5, 3)), MatrixXd::Ones(5, 2)).norm(), 0);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(least_squares(MatrixXd::Constant(5, 2, bad), MatrixXd::Ones(5, 1)), std::invalid_argument);
    EXPECT_THROW(complex_least_squares(MatrixXcd::Ones(5, 2), MatrixXcd::Constant(5, 1, bad)),
                 std::invalid_argument);
  }
}

}  // namespace
}  // namespace beamid::experiments::least_squares_test
