// Oracle: the format's own definition and examples [boisvert1996].
#include "experiments/text/matrix_market.hpp"

#include <gtest/gtest.h>

#include "experiments/text/input_error.hpp"

namespace beamid::experiments::matrix_market_test {
namespace {

Eigen::MatrixXd parsed(const std::string& text) {
  return parse_matrix_market(text, "m.mtx");
}

std::string complaint(const std::string& text) {
  try {
    parsed(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

const std::string general = "%%MatrixMarket matrix coordinate real general\n",
                  symmetric = "%%MatrixMarket matrix coordinate real symmetric\n",
                  array = "%%MatrixMarket matrix array real general\n";

TEST(MatrixMarket, ReadsEntriesWithCommentsBetweenThem) {
  Eigen::MatrixXd expected(2, 3);
  expected << 1.5, 0, -2e3, 0, 0, 7;
  EXPECT_EQ(parsed(general + "% from a program\n2 3 3\n1 1 1.5\n\n% more\n1 3 -2E+3\n2 3 +7\n"), expected);
}

TEST(MatrixMarket, CompletesSymmetricMatrices) {
  Eigen::Matrix2d expected;
  expected << 2, -1, -1, 1;
  EXPECT_EQ(parsed(symmetric + "2 2 3\n1 1 2\n2 1 -1\n2 2 1\n"), expected);
  EXPECT_EQ(parsed("%%MatrixMarket matrix array integer symmetric\n2 2\n2\n-1\n1\n"), expected);
}

TEST(MatrixMarket, ReadsArraysColumnByColumn) {
  Eigen::Matrix2d expected;
  expected << 1, 3, 2, 4;
  EXPECT_EQ(parsed(array + "2 2\n1\n2\n3\n4\n"), expected);
}

TEST(MatrixMarket, AddsEntriesAtOnePlace) {
  EXPECT_EQ(parsed(general + "1 1 2\n1 1 2\n1 1 3\n")(0, 0), 5.0);
}

TEST(MatrixMarket, SaysWhereAFileIsWrong) {
  EXPECT_EQ(complaint("1 2 3\n").substr(0, 8), "m.mtx:1:");
  EXPECT_EQ(complaint("%%MatrixMarket matrix coordinate complex general\n").substr(0, 8), "m.mtx:1:");
  EXPECT_EQ(complaint(general + "2 2 1\n3 1 1\n"), "m.mtx:3: row is 3; expected a whole number from 1 to 2");
  EXPECT_EQ(complaint(general + "2 2 1\n1 1 x\n"), "m.mtx:3: value is 'x'; expected a number");
  EXPECT_EQ(complaint(general + "2 2 1\n1 1 nan\n"), "m.mtx:3: value is 'nan'; expected a number");
  EXPECT_EQ(complaint(general + "2 2 2\n1 1 1\n"), "m.mtx:4: the file ends after 1 of 2 entries");
  EXPECT_EQ(complaint(general + "2 2 1\n1 1 1\n2 2 1\n"), "m.mtx:4: a line behind the last of 1 entries");
  EXPECT_EQ(complaint(symmetric + "2 3 1\n1 1 1\n"),
            "m.mtx:2: a symmetric matrix of 2 x 3; expected a square one");
  EXPECT_EQ(complaint(general + "2 2\n"), "m.mtx:2: 2 numbers; expected rows, columns and entries");
}

// Sizes that no file of this length could fill are met before anything is allocated.
TEST(MatrixMarket, RefusesSizesBeyondSense) {
  EXPECT_EQ(complaint(general + "5e12 5e12 1\n1 1 1\n").substr(0, 8), "m.mtx:2:");
  EXPECT_EQ(complaint(array + "1000000 1000000\n1\n").substr(0, 8), "m.mtx:2:");
}

}  // namespace
}  // namespace beamid::experiments::matrix_market_test
