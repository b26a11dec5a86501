// Oracles: the known answers published with the generator, and the moments that draws must have.
#include "filters/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace beamid::filters::random_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Words = std::array<std::uint32_t, 4>;

TEST(Philox, GivesThePublishedWords) {
  // Oracle: the known-answer vectors of Philox 4x32-10 that come with [salmon2011].
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomStream, IsNormalUniformAndRepeatable) {
  // Oracle: moments of the distributions, to four standard errors.
  constexpr Index n = 200'000;
  RandomStream random(7);
  const Eigen::ArrayXd x = random.normal(1, n).transpose().array();
  const double root = std::sqrt(static_cast<double>(n));
  EXPECT_NEAR(x.mean(), 0.0, 4.0 / root);
  EXPECT_NEAR(x.square().mean(), 1.0, 4.0 * std::sqrt(2.0) / root);
  EXPECT_NEAR(x.pow(4).mean(), 3.0, 4.0 * std::sqrt(96.0) / root);
  double sum = 0.0, least = 1.0, largest = 0.0;
  for (Index i = 0; i < n; ++i) {
    const double u = random.uniform();
    sum += u, least = std::min(least, u), largest = std::max(largest, u);
  }
  EXPECT_NEAR(sum / n, 0.5, 4.0 / std::sqrt(12.0) / root);
  EXPECT_GT(least, 0.0);
  EXPECT_LT(largest, 1.0);
  EXPECT_EQ(RandomStream(7).normal(3, 5), RandomStream(7).normal(3, 5));
  EXPECT_NE(RandomStream(7).normal(3, 5), RandomStream(8).normal(3, 5));
}

// Oracle: the same numbers one by one. Lengths beside those that vectors and tables have.
TEST(NormalNoise, IsThatOfTheStreamToRounding) {
  for (const Index count : {1, 2, 255, 256, 257, 1001}) {
    const VectorXd found = normal_noise(count, 7, (std::uint64_t{3} << 32) + 5);
    const VectorXd expected = RandomStream(7, (std::uint64_t{3} << 32) + 5).normal(count, 1);
    ASSERT_EQ(found.size(), count);
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 5e-15) << count;
  }
}

TEST(ExactDraws, HaveTheMomentsToRounding) {
  RandomStream random(3);
  const MatrixXd others = random.normal(4, 20).colwise() - VectorXd::Zero(4);
  const Draws draws = exact_draws(random, 3, 20, others);
  EXPECT_TRUE(draws.exact);
  EXPECT_LT(draws.values.rowwise().mean().norm(), 1e-14);
  EXPECT_LT((draws.values * draws.values.transpose() / 19.0 - MatrixXd::Identity(3, 3)).norm(), 1e-13);
  EXPECT_LT((draws.values * others.transpose()).norm(), 1e-12);
}

TEST(ExactDraws, SayWhereThereIsNoRoomForThem) {
  RandomStream random(3);
  EXPECT_TRUE(exact_draws(random, 3, 4, MatrixXd(0, 4)).exact);
  const Draws draws = exact_draws(random, 4, 4, MatrixXd(0, 4));
  EXPECT_FALSE(draws.exact);
  EXPECT_LT(draws.values.rowwise().mean().norm(), 1e-15);
}

}  // namespace
}  // namespace beamid::filters::random_test
