// What a run shows about itself. Oracles: definitions, series made for the purpose, closed forms.
#include "filters/diagnostics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "beamid/testing/oscillator.hpp"

namespace beamid::diagnostics_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class Diagnosis : public testing::Test {
 protected:
  MatrixXd white(Index outputs, Index samples) {
    return MatrixXd::NullaryExpr(outputs, samples, [&] { return normal_(random_); });
  }
  filters::FilterRun run_of(const MatrixXd& innovations) {
    filters::FilterRun run;
    run.innovations = run.whitened_innovations = innovations;
    run.normalised_squares.resize(innovations.cols());
    for (Index k = 0; k < innovations.cols(); ++k) {
      const VectorXd column = innovations.col(k);
      const auto there = !column.array().isNaN();
      run.normalised_squares[k] = there.any() ? there.select(column, 0.0).squaredNorm() : nan;
    }
    return run;
  }

  std::mt19937 random_{13};
  std::normal_distribution<double> normal_;
};

TEST_F(Diagnosis, CountsOnlyWhatWasMeasured) {
  // Oracle: the compressed record for a channel that is missing as a whole, degrees of freedom for the rest.
  MatrixXd innovations = white(2, 600);
  MatrixXd kept(2, 400);
  for (Index k = 0; k < 600; ++k) {
    if (k % 3 == 1)
      innovations.col(k).setConstant(nan);
    else
      kept.col(2 * (k / 3) + (k % 3 == 2)) = innovations.col(k);
  }
  const auto gappy = filters::innovation_consistency(run_of(innovations));
  const auto full = filters::innovation_consistency(run_of(kept));
  EXPECT_EQ(gappy.mean_normalised_square, full.mean_normalised_square);
  EXPECT_EQ(gappy.lower_95, full.lower_95);
  EXPECT_EQ(gappy.windows, full.windows);
  EXPECT_EQ(gappy.window_upper_95, full.window_upper_95);

  MatrixXd partial = white(2, 600);
  partial.row(1).head(300).setConstant(nan);
  const auto some = filters::innovation_consistency(run_of(partial));
  const double sum = partial.row(0).squaredNorm() + partial.row(1).tail(300).squaredNorm();
  EXPECT_NEAR(some.mean_normalised_square, sum / 900.0, 1e-14);
  EXPECT_TRUE(some.size_is_right());
}

TEST_F(Diagnosis, OfWhitenessKeepsItsLevelWhereSamplesAreMissing) {
  // Oracle: the test's level of 5 % over 2000 runs, a third of each series missing; and its power.
  int alarms = 0;
  for (int i = 0; i < 2000; ++i) {
    VectorXd series = white(1, 400).transpose();
    for (double& x : series)
      if (std::uniform_real_distribution<double>()(random_) < 1.0 / 3.0) x = nan;
    alarms += filters::whiteness_of(series).p_value < 0.05;
  }
  EXPECT_NEAR(alarms / 2000.0, 0.05, 0.02);
  VectorXd coloured = white(1, 2000).transpose();
  for (Index k = 1; k < 2000; ++k) coloured[k] += 0.4 * coloured[k - 1];
  for (Index k = 0; k < 2000; k += 5) coloured[k] = nan;
  EXPECT_LT(filters::whiteness_of(coloured).p_value, 1e-6);
}

TEST(WhitenessOfNothing, IsNoError) {
  EXPECT_EQ(filters::whiteness_of(VectorXd::Constant(50, nan)).p_value, 1.0);
  EXPECT_EQ(filters::whiteness_of(VectorXd::Zero(0)).p_value, 1.0);
  EXPECT_LT(filters::whiteness_of(VectorXd::Ones(50)).p_value, 0.05);
}

TEST_F(Diagnosis, HistogramCountsEveryReadingOnce) {
  // Oracle: the normal distribution: chi-square of the counts about those expected.
  MatrixXd innovations = white(2, 20000);
  innovations(0, 5) = 100.0;
  innovations(1, 7) = nan;
  const auto histogram = filters::innovation_histogram(run_of(innovations));
  EXPECT_EQ(histogram.counts.row(0).sum(), 20000.0);
  EXPECT_EQ(histogram.counts.row(1).sum(), 19999.0);
  EXPECT_NEAR(histogram.expected.row(0).sum(), 20000.0, 1e-8);
  EXPECT_GE(histogram.counts(0, 39), 1.0);
  double square = 0.0;
  int bins = 0;
  for (Index b = 0; b < 40; ++b) {
    if (histogram.expected(1, b) < 10.0) continue;
    square += std::pow(histogram.counts(1, b) - histogram.expected(1, b), 2) / histogram.expected(1, b);
    ++bins;
  }
  EXPECT_LT(square, bins + 4.0 * std::sqrt(2.0 * bins));
}

TEST(InformationGain, IsThatOfTheRecordAgainstThePrior) {
  // Oracle: independent unknowns, one seen a hundred times better than known before, one not at all; then the
  // same turned by a rotation of the prior's own axes.
  const MatrixXd before = Eigen::Vector2d(4.0, 9.0).asDiagonal();
  const MatrixXd after = Eigen::Vector2d(0.04, 9.0).asDiagonal();
  const auto gain = filters::information_gain(before, after);
  ASSERT_TRUE(gain);
  EXPECT_NEAR(gain->ratios[0], 0.01, 1e-14);
  EXPECT_NEAR(gain->ratios[1], 1.0, 1e-14);
  EXPECT_EQ(gain->rank, 1);
  EXPECT_FALSE(filters::information_gain(MatrixXd::Zero(2, 2), after));  // known exactly: nothing to gain
  EXPECT_THROW(filters::information_gain(before, MatrixXd::Ones(1, 1)), std::invalid_argument);
}

TEST_F(Diagnosis, OfAConsistentRunFindsNothingWrong) {
  // Oracle: how the record was made; one seed of those that pass all tests at 5 %.
  const double dt = 4e-3, noise = 1e-4;
  const auto model = [&] {
    return filters::discretise(std::make_shared<test::Oscillator>(3.0, 2), dt, "exponential",
                               {{}, noise * noise * MatrixXd::Identity(2, 2)});
  };
  const auto exact = model();
  filters::Measurements record{VectorXd::LinSpaced(1500, 0.0, 1499 * dt), MatrixXd(2, 1500), {}};
  VectorXd z = Eigen::Vector4d(0.012, 0.0, 515.8, 1.2), next;
  for (Index k = 0; k < 1500; ++k) {
    record.outputs.col(k) = z.head(2) + noise * white(2, 1);
    exact->transition(z, {}, next);
    z.swap(next);
  }
  record.outputs.row(1).segment(400, 300).setConstant(nan);
  const filters::Gaussian initial{Eigen::Vector4d(0.012, 0.0, 510.0, 1.3),
                                  Eigen::Vector4d(1e-6, 1e-4, 100.0, 0.04).asDiagonal()};
  const auto filter = filters::filter_registry().make("ekf", {}, model());
  const filters::FilterRun run = filters::run(*filter, initial, record);
  const filters::Diagnostics found = filters::diagnose(run, initial, {2, 3});
  ASSERT_TRUE(found.consistency);
  EXPECT_TRUE(found.consistency->size_is_right());
  EXPECT_TRUE(found.consistency->size_is_steady());
  ASSERT_EQ(found.whiteness.size(), 2u);
  for (const filters::Whiteness& whiteness : found.whiteness) EXPECT_GT(whiteness.p_value, 0.01);
  ASSERT_TRUE(found.information);
  EXPECT_EQ(found.information->rank, 2);
  EXPECT_EQ(found.log_likelihood, run.log_likelihood);
  EXPECT_THROW(filters::diagnose(run, initial, {4}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::diagnostics_test
