// The one loop of nonlinear least squares, against published minima.
#include "filters/levenberg_marquardt.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace beamid::test::levenberg_marquardt_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using filters::DescentEnd, filters::MarquardtDamping, filters::TriedStep;

/// Residuals and their slopes at a point.
using Residuals = std::function<VectorXd(const VectorXd&, MatrixXd* jacobian)>;

DescentEnd descend(const Residuals& residuals, VectorXd& x, const MarquardtDamping& rule = {}) {
  MatrixXd jacobian;
  const auto step = [&](double damping) -> VectorXd {
    const VectorXd r = residuals(x, &jacobian);
    return filters::solve_damped(jacobian.transpose() * jacobian, damping, -jacobian.transpose() * r);
  };
  const auto take = [&](const VectorXd& d) {
    const bool lower = residuals(x + d, nullptr).squaredNorm() <= residuals(x, nullptr).squaredNorm();
    if (lower) x += d;
    return TriedStep{lower ? 1.0 : 0.0, d.norm() < 1e-12 * x.norm()};
  };
  return filters::levenberg_marquardt(rule, step, take);
}

// y = b1 (1 - exp(-b2 x)), Misra1a of the Statistical Reference Datasets of NIST.
VectorXd misra(const VectorXd& b, MatrixXd* jacobian) {
  const VectorXd x{
      {77.6, 114.9, 141.1, 190.8, 239.9, 289.0, 332.8, 378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0}},
      y{{10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78}};
  const VectorXd kept = (-b[1] * x).array().exp();
  if (jacobian) {
    jacobian->resize(x.size(), 2);
    jacobian->col(0) = 1.0 - kept.array();
    jacobian->col(1) = b[0] * x.cwiseProduct(kept);
  }
  return b[0] * (1.0 - kept.array()).matrix() - y;
}

TEST(LevenbergMarquardt, FindsTheCertifiedFitOfMisra) {
  // Oracle: certified values of https://www.itl.nist.gov/div898/strd/nls/data/misra1a.shtml, eleven digits.
  VectorXd b{{500.0, 1e-4}};
  EXPECT_EQ(descend(misra, b), DescentEnd::settled);
  EXPECT_NEAR(b[0], 2.3894212918e+02, 1e-7);
  EXPECT_NEAR(b[1], 5.5015643181e-04, 1e-12);  // costs are compared: sqrt(eps) of b, 1e-11, on any processor
  EXPECT_NEAR(misra(b, nullptr).squaredNorm(), 1.2455138894e-01, 1e-10);
}

TEST(LevenbergMarquardt, FollowsTheCurvedValley) {
  // Oracle: Rosenbrock's function, whose minimum is 0 at (1, 1).
  VectorXd x{{-1.2, 1.0}};
  const Residuals valley = [](const VectorXd& at, MatrixXd* jacobian) -> VectorXd {
    if (jacobian) *jacobian = MatrixXd{{-20.0 * at[0], 10.0}, {-1.0, 0.0}};
    return VectorXd{{10.0 * (at[1] - at[0] * at[0]), 1.0 - at[0]}};
  };
  EXPECT_EQ(descend(valley, x), DescentEnd::settled);
  EXPECT_NEAR(x[0], 1.0, 1e-10);
  EXPECT_NEAR(x[1], 1.0, 1e-10);
}

TEST(LevenbergMarquardt, TakesOneStepWhereTheProblemIsLinear) {
  // Oracle: Gauss-Newton without damping is exact there.
  int tried = 0;
  VectorXd x{{3.0}};
  const auto step = [&](double damping) -> VectorXd {
    EXPECT_EQ(damping, 0.0);
    return VectorXd::Constant(1, 2.0 - x[0]);
  };
  const auto take = [&](const VectorXd& d) {
    ++tried;
    x += d;
    return TriedStep{1.0, true};
  };
  EXPECT_EQ(filters::levenberg_marquardt({}, step, take), DescentEnd::settled);
  EXPECT_EQ(tried, 1);
  EXPECT_EQ(x[0], 2.0);
}

TEST(LevenbergMarquardt, SaysThatNoStepLowersTheCost) {
  const auto step = [](double) -> VectorXd { return VectorXd::Ones(1); };
  const auto refuse = [](const VectorXd&) { return TriedStep{}; };
  EXPECT_EQ(filters::levenberg_marquardt({}, step, refuse), DescentEnd::stuck);
  MarquardtDamping few;
  few.most_steps = 3;
  EXPECT_EQ(filters::levenberg_marquardt(few, step, refuse), DescentEnd::exhausted);
}

TEST(LevenbergMarquardt, DampsByWhatTheLinearProblemPromised) {
  // Oracle: the rule of the header by hand: raised to 1e-3, tenfold, kept, fourfold, a tenth.
  const std::vector<double> gains{0.0, 0.0, 0.5, 0.1, 0.9, 1.0};
  std::vector<double> dampings;
  const auto step = [&](double damping) -> VectorXd {
    dampings.push_back(damping);
    return VectorXd::Ones(1);
  };
  const auto take = [&](const VectorXd&) {
    return TriedStep{gains[dampings.size() - 1], dampings.size() == gains.size()};
  };
  filters::levenberg_marquardt({}, step, take);
  const std::vector<double> expected{0.0, 1e-3, 1e-2, 1e-2, 4e-2, 4e-3};
  ASSERT_EQ(dampings.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(dampings[i], expected[i], 1e-15) << i;
}

}  // namespace
}  // namespace beamid::test::levenberg_marquardt_test
