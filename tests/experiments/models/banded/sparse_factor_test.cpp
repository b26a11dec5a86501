#include "experiments/models/banded/step_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <complex>
#include <random>
#include "tests/experiments/models/banded/solved_lanes.hpp"

namespace beamid::experiments::banded::sparse_factor_test {
namespace {

using test::expect_solved;

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd;

using Couplings = std::vector<std::pair<int, int>>;

// Sums of positive definite 2 x 2 matrices at the couplings: real and imaginary parts positive definite.
MatrixXcd coupled(int size, const Couplings& couplings, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> positive(0.1, 1.0), any(-1.0, 1.0);
  MatrixXd parts[2];
  for (MatrixXd& part : parts) {
    part = 1e-2 * MatrixXd::Identity(size, size);
    for (const auto& [i, j] : couplings) {
      const double a = positive(generator), b = any(generator);
      part(i, i) += a * a;
      part(j, j) += b * b;
      part(i, j) += a * b;
      part(j, i) += a * b;
    }
  }
  MatrixXcd matrix(size, size);
  matrix.real() = parts[0];
  matrix.imag() = parts[1];
  return matrix;
}

SymmetricPattern pattern_of(const MatrixXcd& matrix) {
  const fem::SparseMatrix entries = matrix.cwiseAbs().sparseView();
  return {matrix.rows(), {&entries}};
}

std::vector<Complex> entries_of(const MatrixXcd& matrix, const SymmetricPattern& pattern) {
  std::vector<Complex> entries;
  for (Index i = 0; i < pattern.size(); ++i)
    for (int k = pattern.start(i); k < pattern.start(i + 1); ++k)
      entries.push_back({matrix(i, pattern.column(k)).real(), matrix(i, pattern.column(k)).imag()});
  return entries;
}

// Rooms in a grid, `at_each` coordinates in each, all of which know those of the rooms beside.
Couplings grid(int across, int up, int at_each) {
  Couplings couplings;
  const auto place = [&](int x, int y, int k) { return (y * across + x) * at_each + k; };
  for (int y = 0; y < up; ++y)
    for (int x = 0; x < across; ++x)
      for (int k = 0; k < at_each; ++k)
        for (int l = 0; l < at_each; ++l) {
          if (l < k) couplings.emplace_back(place(x, y, k), place(x, y, l));
          if (x > 0) couplings.emplace_back(place(x, y, k), place(x - 1, y, l));
          if (y > 0) couplings.emplace_back(place(x, y, k), place(x, y - 1, l));
        }
  return couplings;
}

// Every two of some coordinates by chance.
Couplings random_couplings(int size, int count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_int_distribution<int> any(0, size - 1);
  Couplings couplings;
  while (static_cast<int>(couplings.size()) < count)
    if (const int i = any(generator), j = any(generator); i != j) couplings.emplace_back(i, j);
  return couplings;
}

std::vector<std::pair<int, Couplings>> structures() {
  return {{1, {}},
          {5, {}},
          {2, {{0, 1}}},
          {60, random_couplings(60, 80, 1)},
          {60, random_couplings(60, 600, 2)},
          {30, random_couplings(30, 900, 3)},  // full: wider than a panel
          {144, grid(8, 6, 3)},
          {120, grid(40, 1, 3)}};
}

TEST(SparseFactor, SolvesLikeADenseMatrixOfAnyStructure) {
  // Oracle: dense elimination with pivoting, and the residual.
  for (const auto& [size, couplings] : structures()) {
    const MatrixXcd matrix = coupled(size, couplings, 7);
    const SymmetricPattern pattern = pattern_of(matrix);
    SparseFactor factor(pattern);
    factor.factor(entries_of(coupled(size, couplings, 8), pattern));  // leaves nothing behind
    factor.factor(entries_of(matrix, pattern));
    const auto [right, found] = expect_solved(matrix, factor, std::to_string(size));
    const MatrixXcd expected = matrix.partialPivLu().solve(right);
    EXPECT_LT((found - expected).norm(), 1e-11 * expected.norm()) << size;
  }
}

TEST(SparseFactor, GrowsNoEntryBeyondThreeTimesTheLargest) {
  // Oracle: the bound for matrices whose real and imaginary parts are positive definite [george2002].
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const MatrixXcd matrix = coupled(144, grid(8, 6, 3), seed);
    const SymmetricPattern pattern = pattern_of(matrix);
    SparseFactor factor(pattern);
    factor.factor(entries_of(matrix, pattern));
    EXPECT_LE(factor.growth(entries_of(matrix, pattern)), 3.0);
    EXPECT_GT(factor.growth(entries_of(matrix, pattern)), 0.3);
  }
}

TEST(SparseFactor, FillsALadderInProportionToItsLength) {
  // Oracle: a chain of rooms that is cut anywhere falls apart, so that each fills a number of entries of its
  // own.
  const auto stored = [](int length) {
    const Couplings couplings = grid(2, length, 3);
    fem::SparseMatrix entries(6 * length, 6 * length);
    for (const auto& [i, j] : couplings) entries.coeffRef(i, j) = entries.coeffRef(j, i) = 1.0;
    return static_cast<double>(SparseFactor(SymmetricPattern(6 * length, {&entries})).stored());
  };
  EXPECT_LT(stored(400), 2.1 * stored(200));
  EXPECT_LT(stored(200), 40.0 * 1200);
}

TEST(SparseFactor, RefusesWhatIsSingular) {
  const SymmetricPattern pattern = pattern_of(coupled(144, grid(8, 6, 3), 1));
  SparseFactor factor(pattern);
  EXPECT_THROW(factor.factor(std::vector<Complex>(pattern.entries())), std::runtime_error);
}

}  // namespace
}  // namespace beamid::experiments::banded::sparse_factor_test
