// Oracles: innovations drawn as a consistent filter's must be, tables of chi-square, and the Ljung-Box
// statistic worked out with 25 digits (mpmath 1.2).
#include "filters/diagnostics.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <random>

namespace beamid::innovation_consistency_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::innovation_consistency, filters::InnovationConsistency;

// A run with these innovations (p x N), of which the filter says that they have the deviation `assumed`.
filters::FilterRun run_of(const MatrixXd& innovations, double assumed = 1.0) {
  filters::FilterRun run;
  run.innovations = innovations;
  run.whitened_innovations = innovations / assumed;
  run.normalised_squares = innovations.colwise().squaredNorm().transpose() / (assumed * assumed);
  return run;
}

class Innovations : public testing::Test {
 protected:
  MatrixXd white(Index outputs, Index samples) {
    return MatrixXd::NullaryExpr(outputs, samples, [&] { return normal_(random_); });
  }
  // x_k = a x_k-1 + sqrt(1 - a^2) e_k: variance 1, correlation a.
  MatrixXd coloured(double a, Index samples) {
    MatrixXd x = white(1, samples);
    for (Index k = 1; k < samples; ++k) x(0, k) = a * x(0, k - 1) + std::sqrt(1.0 - a * a) * x(0, k);
    return x;
  }

 private:
  std::mt19937 random_{17};
  std::normal_distribution<double> normal_;
};

// Whether `count` of `runs` is what a probability p gives, in a 99.9 % band.
bool plausible(int count, int runs, double p) {
  const boost::math::binomial distribution(runs, p);
  return count >= quantile(distribution, 0.0005) && count <= quantile(distribution, 0.9995);
}

TEST_F(Innovations, OfAConsistentFilterRaiseTheAlarmOnceInTwenty) {
  // Oracle: the tests' own level of 5 %. Bonferroni over ten nearly independent windows gives 4.9 %. The
  // chi-square of Ljung-Box is an approximation at finite length, hence its wider band.
  constexpr int runs = 2000;
  for (const Index outputs : {1, 2}) {
    int wrong_size = 0, unsteady = 0, not_white = 0;
    for (int i = 0; i < runs; ++i) {
      const InnovationConsistency result = innovation_consistency(run_of(white(outputs, 1000)));
      wrong_size += !result.size_is_right();
      unsteady += !result.size_is_steady();
      not_white += !result.white();
    }
    EXPECT_TRUE(plausible(wrong_size, runs, 0.05)) << wrong_size << " of " << runs;
    EXPECT_TRUE(plausible(unsteady, runs, 0.049)) << unsteady << " of " << runs;
    EXPECT_NEAR(static_cast<double>(not_white) / runs, 0.05, 0.02) << not_white << " of " << runs;
  }
}

TEST_F(Innovations, TellWhetherRIsTooLargeOrTooSmall) {
  // Oracle: the mean normalised square is (true / assumed deviation)^2.
  for (const double assumed : {0.8, 0.9, 1.1, 1.25}) {
    const InnovationConsistency result = innovation_consistency(run_of(white(1, 2000), assumed));
    EXPECT_FALSE(result.size_is_right()) << assumed;
    EXPECT_NEAR(result.mean_normalised_square, 1.0 / (assumed * assumed), 0.2) << assumed;
    EXPECT_TRUE(result.white()) << assumed;  // size and colour are different questions
  }
}

TEST_F(Innovations, TellWhetherTheirSizeChangesAlongTheRecord) {
  // Oracle: by construction. The mean over the whole is right, which is why windows are looked at.
  MatrixXd innovations = white(1, 2000);
  innovations.leftCols(1000) *= std::sqrt(1.5);
  innovations.rightCols(1000) *= std::sqrt(0.5);
  const InnovationConsistency result = innovation_consistency(run_of(innovations));
  EXPECT_TRUE(result.size_is_right()) << result.mean_normalised_square;
  EXPECT_FALSE(result.size_is_steady());
}

TEST_F(Innovations, TellWhetherTheyAreCorrelated) {
  for (const double correlation : {-0.3, 0.2, 0.9}) {
    const InnovationConsistency result = innovation_consistency(run_of(coloured(correlation, 2000)));
    EXPECT_FALSE(result.white()) << correlation;
    EXPECT_NEAR(result.lag_one_correlation, correlation, 4.0 / std::sqrt(2000.0)) << correlation;
  }
}

TEST_F(Innovations, TellSoInSpiteOfALargeFirstOne) {
  // A filter that starts without knowing the amplitude has an innovation there of a hundred times the noise,
  // and says so in its covariance: normalised it is like any other.
  filters::FilterRun run = run_of(coloured(0.3, 2000));
  run.innovations(0, 0) = 100.0;
  run.whitened_innovations(0, 0) = run.normalised_squares[0] = 1.0;
  const InnovationConsistency result = innovation_consistency(run);
  EXPECT_FALSE(result.white());
  EXPECT_NEAR(result.lag_one_correlation, 0.3, 4.0 / std::sqrt(2000.0));
}

TEST(InnovationBands, AreThoseOfTheChiSquareTables) {
  // Oracle: chi-square of 100 degrees, 2.5 % and 97.5 %: 74.2219 and 129.561 in any table; of 10 degrees,
  // 0.25 % and 99.75 %: 1.82740 and 27.1122.
  const InnovationConsistency result = innovation_consistency(run_of(MatrixXd::Ones(1, 100)));
  EXPECT_NEAR(result.lower_95, 0.742219, 1e-6);
  EXPECT_NEAR(result.upper_95, 1.29561, 1e-5);
  EXPECT_NEAR(result.window_lower_95, 0.182740, 1e-6);
  EXPECT_NEAR(result.window_upper_95, 2.71122, 1e-5);
}

TEST(InnovationBands, NarrowWithTheNumberOfOutputs) {
  // Oracle: 100 samples of 5 outputs have 500 degrees: 439.936 and 563.852; windows 50.
  const InnovationConsistency result = innovation_consistency(run_of(MatrixXd::Ones(5, 100)));
  EXPECT_DOUBLE_EQ(result.mean_normalised_square, 1.0);
  EXPECT_NEAR(result.lower_95, 439.935991 / 500.0, 1e-8);
  EXPECT_NEAR(result.upper_95, 563.851529 / 500.0, 1e-8);
}

TEST(LjungBox, HasTheStatisticOfItsDefinition) {
  // Oracle: x_t = sin t^2 + 0.3 sin (t-1)^2, t = 0..199: Q = 23.48956 over 20 lags, p = 0.2654001.
  MatrixXd innovations(1, 200);
  for (int t = 0; t < 200; ++t)
    innovations(0, t) = std::sin(double(t) * t) + 0.3 * std::sin(double(t - 1) * (t - 1));
  const InnovationConsistency result = innovation_consistency(run_of(innovations));
  EXPECT_NEAR(result.lag_one_correlation, 0.262850272069789, 1e-12);
  EXPECT_NEAR(result.whiteness_p_value, 0.265400100704765, 1e-10);
  EXPECT_NEAR(result.mean_normalised_square, 0.521985073467162, 1e-12);
}

TEST(UnusualInnovations, AreNotWhiteAndNoError) {
  // A filter may wander off without failing: innovations beyond all bounds, or stuck at one value.
  MatrixXd innovations = MatrixXd::Constant(1, 200, 1e200);
  innovations(0, 100) = -1e200;
  EXPECT_FALSE(innovation_consistency(run_of(innovations)).white());
  EXPECT_FALSE(innovation_consistency(run_of(innovations)).size_is_right());
  EXPECT_FALSE(innovation_consistency(run_of(MatrixXd::Zero(1, 200))).white());
}

TEST_F(Innovations, AreTestedUpToWhereTheFilterFailed) {
  // Oracle: the same innovations without those that were never reached.
  filters::FilterRun run = run_of(white(1, 400));
  const InnovationConsistency part = innovation_consistency(run_of(run.innovations.leftCols(250)));
  run.failure = filters::Failure{250, 2.5, "covariance is not positive", -1.0};
  const InnovationConsistency result = innovation_consistency(run);
  EXPECT_EQ(result.mean_normalised_square, part.mean_normalised_square);
  EXPECT_EQ(result.whiteness_p_value, part.whiteness_p_value);
  run.failure->step = 99;
  EXPECT_THROW(innovation_consistency(run), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::innovation_consistency_test
