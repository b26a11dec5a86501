// The iterated filter against the minimum that it seeks.
#include <gtest/gtest.h>

#include <cmath>

#include "filters/filter_run.hpp"
#include "tests/filters/classic/function_model.hpp"

namespace beamid::test::iekf_test {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using filters::filter_registry;

// y = atan(5 z) + v of a scalar: Gauss-Newton overshoots wherever it starts far away.
std::unique_ptr<filters::DiscreteModel> arc(double noise) {
  const auto f = [](const VectorXd& z, const VectorXd&, VectorXd& next) { next = z; };
  const auto h = [](const VectorXd& z, const VectorXd&, VectorXd& y) { y[0] = std::atan(5.0 * z[0]); };
  return std::make_unique<FunctionModel>(f, h, MatrixXd::Zero(1, 1), MatrixXd::Constant(1, 1, noise * noise));
}

double corrected(const std::string& name, const filters::Options& options, double noise, double reading) {
  const auto filter = filter_registry().make(name, options, arc(noise));
  filter->reset({VectorXd::Constant(1, 1.5), MatrixXd::Ones(1, 1)});
  filter->correct(VectorXd::Constant(1, reading), {});
  return filter->estimate().mean[0];
}

TEST(Iekf, FindsTheMostProbableState) {
  // Oracle: the minimum of (z - 1.5)^2 + (y - atan 5z)^2 / R on a fine grid.
  for (const double noise : {1.0, 0.1, 0.01})
    for (const double reading : {-1.4, 0.0, 0.3, 1.3}) {
      double best = 0.0, least = 1e300;
      for (double z = -3.0; z < 5.0; z += 1e-4) {
        const double residual = (reading - std::atan(5.0 * z)) / noise;
        const double cost = (z - 1.5) * (z - 1.5) + residual * residual;
        if (cost < least) least = cost, best = z;
      }
      EXPECT_NEAR(corrected("iekf", {{"iterations", 100.0}}, noise, reading), best, 1e-3)
          << noise << " " << reading;
    }
}

TEST(Iekf, IsTheExtendedFilterInOneIteration) {
  // Where the first step lowers the cost: else it would be halved.
  const double once = corrected("iekf", {{"iterations", 1.0}}, 1.0, 1.3);
  EXPECT_NEAR(once, corrected("ekf", {}, 1.0, 1.3), 1e-14);
}

TEST(Iekf, SaysHowOftenItDidNotConverge) {
  const auto filter = filter_registry().make("iekf", {{"iterations", 1.0}}, arc(0.1));
  filter->reset({VectorXd::Constant(1, 1.5), MatrixXd::Ones(1, 1)});
  EXPECT_TRUE(filter->remarks().empty());
  filter->correct(VectorXd::Constant(1, 0.3), {});
  ASSERT_EQ(filter->remarks().size(), 1u);
  EXPECT_NE(filter->remarks()[0].find("1 of 1"), std::string::npos);
}

TEST(Iekf, RefusesIterationsThatAreNone) {
  for (const double iterations : {0.0, 1.5, -3.0, std::nan("")})
    EXPECT_THROW(filter_registry().make("iekf", {{"iterations", iterations}}, arc(1.0)),
                 std::invalid_argument);
  EXPECT_THROW(filter_registry().make("iekf", {{"tolerance", 0.0}}, arc(1.0)), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::test::iekf_test
