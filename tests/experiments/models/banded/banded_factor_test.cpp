#include "experiments/models/banded/banded_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <complex>
#include <random>
#include "tests/experiments/models/banded/solved_lanes.hpp"

namespace beamid::experiments::banded::banded_factor_test {
namespace {

using test::expect_solved;

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd;

// A complex symmetric band with positive definite real and imaginary parts.
MatrixXcd band(Index size, int width, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  MatrixXd parts[2];
  for (MatrixXd& part : parts) {
    MatrixXd lower = MatrixXd::Zero(size, size);
    for (Index i = 0; i < size; ++i)
      for (Index j = std::max<Index>(0, i - width); j <= i; ++j) lower(i, j) = normal(generator);
    part = lower * lower.transpose() + 1e-3 * MatrixXd::Identity(size, size);
  }
  MatrixXcd matrix(size, size);
  matrix.real() = parts[0];
  matrix.imag() = parts[1];
  return matrix;
}

BandedFactor filled(const MatrixXcd& matrix, int width) {
  BandedFactor factor(matrix.rows(), width);
  for (Index i = 0; i < matrix.rows(); ++i)
    for (int k = 0; k <= factor.width(); ++k)
      if (const Index j = i - factor.width() + k; j >= 0)
        factor.row(i)[k] = {matrix(i, j).real(), matrix(i, j).imag()};
  return factor;
}

TEST(BandedFactor, SolvesLikeADenseMatrixInEveryWidth) {
  // Oracle: dense elimination with pivoting, and the residual.
  for (const int width : {1, 2, 3, 4, 5, 7, 8, 9, 16, 20, 32})
    for (const Index size : {Index{1}, Index{4}, Index{60}}) {
      const MatrixXcd matrix = band(size, width, static_cast<unsigned>(width));
      BandedFactor factor = filled(matrix, width);
      factor.factor();
      const auto [right, found] =
          expect_solved(matrix, factor, std::to_string(width) + " " + std::to_string(size));
      const MatrixXcd expected = matrix.partialPivLu().solve(right);
      EXPECT_LT((found - expected).norm(), 1e-9 * expected.norm()) << width << " " << size;
    }
}

TEST(BandedFactor, GrowsNoEntryBeyondThreeTimesTheLargest) {
  // Oracle: the bound for matrices whose real and imaginary parts are positive definite [george2002].
  for (unsigned seed = 1; seed <= 20; ++seed) {
    BandedFactor factor = filled(band(80, 3, seed), 3);
    const std::vector<Complex> before = factor.rows();
    factor.factor();
    EXPECT_LE(factor.growth(before), 3.0);
  }
}

TEST(BandedFactor, RefusesWideBandsAndSingularOnes) {
  EXPECT_THROW(BandedFactor(100, 33), std::invalid_argument);
  BandedFactor empty(10, 3);
  EXPECT_THROW(empty.factor(), std::runtime_error);
}

}  // namespace
}  // namespace beamid::experiments::banded::banded_factor_test
