// Oracle: the sine itself, earlier.
#include "experiments/signal/interpolation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace beamid::experiments::shifted_test {
namespace {

TEST(Shifted, IsTheSignalEarlierWhereItIsKnown) {
  const Eigen::Index count = 400;
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(count, 1.0, 1.0 + 0.01 * 399);
  const auto wave = [](double t) {
    return std::sin(2.0 * std::numbers::pi * 21.0 * t) + 0.3 * std::cos(40.0 * t);
  };
  Eigen::VectorXd signal = time.unaryExpr(wave);
  signal.segment(200, 3).setConstant(std::numeric_limits<double>::quiet_NaN());
  for (const double by : {0.0373, -0.2061}) {
    const Eigen::VectorXd moved = shifted(time, signal, by);
    Eigen::Index known = 0;
    for (Eigen::Index k = 0; k < count; ++k)
      if (std::isfinite(moved[k])) {
        EXPECT_NEAR(moved[k], wave(time[k] + by), 2e-3) << by << " at " << k;
        ++known;
      }
    EXPECT_NEAR(static_cast<double>(known), count - std::abs(by) / 0.01 - 32 - 35, 20.0);
    EXPECT_EQ(shifted(time, time, 0.0), time);
  }
}

}  // namespace
}  // namespace beamid::experiments::shifted_test
