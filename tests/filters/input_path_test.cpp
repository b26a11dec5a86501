// How sampled inputs run between their samples. Oracle: the sinusoids that were sampled.
#include "filters/step_input.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace beamid::input_path_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::InputPaths, filters::StepInput;

VectorXd stamps(Index samples, double dt) {
  return VectorXd::LinSpaced(samples, 0.0, dt * static_cast<double>(samples - 1));
}

VectorXd path_at(const InputPaths& path, Index step, double s) {
  const VectorXd column = path.columns.col(step);
  return StepInput(column, column.size() / (path.degree + 1)).at(s);
}

// The largest distance from sin(2 pi t / period) over the steps [first, last), of several phases.
double error(double period, Index first, Index last, bool band_limited = true) {
  const Index samples = 100;
  const double turn = 2.0 * std::numbers::pi / period;
  double worst = 0.0;
  for (const double phase : {0.0, 0.7, 1.4}) {
    const VectorXd time = stamps(samples, 1.0);
    const MatrixXd sampled = (turn * time.array() + phase).sin().matrix().transpose();
    const InputPaths path =
        band_limited ? filters::band_limited_path(time, sampled, 0.0) : filters::straight_path(sampled);
    for (Index k = first; k < last; ++k)
      for (const double s : {0.0, 0.13, 0.37, 0.5, 0.71, 0.94, 1.0})
        worst = std::max(
            worst, std::abs(path_at(path, k, s)[0] - std::sin(turn * (static_cast<double>(k) + s) + phase)));
  }
  return worst;
}

TEST(InputPath, IsTheBandLimitedSignalThatWasSampled) {
  EXPECT_LT(error(60.0, 20, 79), 6e-7);
  EXPECT_LT(error(10.0, 20, 79), 8e-6);
  EXPECT_LT(error(3.0, 20, 79), 2e-3);
  EXPECT_LT(error(2.5, 20, 79), 4e-3);
  EXPECT_GT(error(10.0, 20, 79, false), 0.04);  // of the straight one: (pi/10)^2 / 2
}

TEST(InputPath, GoesToTheEndsOfTheRecord) {
  EXPECT_LT(error(60.0, 0, 99), 5e-4);
  EXPECT_LT(error(10.0, 0, 99), 1e-2);
  EXPECT_LT(error(10.0, 4, 95), 1e-3);
}

TEST(InputPath, PassesThroughItsSamples) {
  const VectorXd time = stamps(40, 0.01);
  const MatrixXd samples = MatrixXd::Random(2, 40);
  for (const InputPaths& path :
       {filters::straight_path(samples), filters::band_limited_path(time, samples, 1e-6)})
    for (Index k = 0; k + 1 < 40; ++k) {
      EXPECT_EQ(path_at(path, k, 0.0), samples.col(k));
      EXPECT_LT((path_at(path, k, 1.0) - samples.col(k + 1)).norm(), 1e-12);
    }
}

TEST(InputPath, IsStraightOverAGapAndBandLimitedOnBothSides) {
  // Oracle: the path of each side alone.
  VectorXd time = stamps(80, 0.01);
  time.tail(40).array() += 0.25;
  const MatrixXd samples = (2.0 * std::numbers::pi * 7.0 * time.array()).sin().matrix().transpose();
  const InputPaths path = filters::band_limited_path(time, samples, 1e-6),
                   left = filters::band_limited_path(time.head(40), samples.leftCols(40), 1e-6),
                   right = filters::band_limited_path(time.tail(40), samples.rightCols(40), 1e-6),
                   straight = filters::straight_path(samples);
  EXPECT_EQ(path.band_limited, 78);
  EXPECT_EQ(path.columns.leftCols(39), left.columns.leftCols(39));
  EXPECT_EQ(path.columns.rightCols(40), right.columns);
  EXPECT_EQ(path.columns.col(39).head(2), straight.columns.col(39));
  EXPECT_TRUE(path.columns.col(39).tail(3).isZero(0.0));
}

TEST(InputPath, IsStraightWhereNoStampsAreEven) {
  VectorXd time = stamps(60, 0.01);
  for (Index k = 1; k < 60; k += 3) time[k] += 0.002;
  const MatrixXd samples = MatrixXd::Random(1, 60);
  const InputPaths path = filters::band_limited_path(time, samples, 1e-4);
  EXPECT_EQ(path.band_limited, 0);
  EXPECT_EQ(path.columns.topRows(2), filters::straight_path(samples).columns);
}

TEST(InputPath, IsTheSameInParts) {
  const VectorXd time = stamps(40, 0.01);
  const InputPaths path = filters::band_limited_path(time, MatrixXd::Random(2, 40), 1e-6),
                   parts = filters::in_parts(path, 5);
  ASSERT_EQ(parts.columns.cols(), 39 * 5 + 1);
  for (Index k = 0; k < 39 * 5; ++k)
    for (const double s : {0.0, 0.3, 1.0})
      EXPECT_LT((path_at(parts, k, s) - path_at(path, k / 5, (static_cast<double>(k % 5) + s) / 5.0)).norm(),
                1e-12);
}

TEST(StepInput, HasTheMeanAndSlopeOfThePadeStep) {
  // Oracle: of u = s^j, (u(0) + u(1)) / 2 - (u'(1) - u'(0)) / 12 and u(1) - u(0) by hand.
  const double means[] = {1.0, 1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0, 1.0 / 6.0};
  for (int j = 0; j <= 4; ++j) {
    const VectorXd path = VectorXd::Unit(5, j);
    const StepInput input(path, 1);
    EXPECT_NEAR(input.mean()[0], means[j], 1e-15) << j;
    EXPECT_EQ(input.slope()[0], j == 0 ? 0.0 : 1.0) << j;
  }
}

TEST(StepInput, RefusesWhatIsNoMultipleOfTheInputs) {
  EXPECT_THROW(StepInput(VectorXd::Zero(3), 2), std::invalid_argument);
  EXPECT_THROW(StepInput(VectorXd::Zero(1), 2), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::input_path_test
