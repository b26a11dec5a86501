#include "experiments/signal/toolbox.hpp"

#include <gtest/gtest.h>

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
