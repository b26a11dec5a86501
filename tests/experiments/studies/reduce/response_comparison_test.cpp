// Oracles: one oscillator, whose receptance and half-power width have closed forms; decibels by hand.
#include "experiments/studies/reduce/report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beamid::experiments::response_comparison_test {
namespace {

using Eigen::VectorXd;
using std::numbers::pi;

TEST(ResponseGrid, IsFineAtEveryResonance) {
  const VectorXd omega{{0.0, 2 * pi * 4.0, 2 * pi * 26.0, 2 * pi * 500.0}};
  const VectorXd grid = response_grid(1.0, 80.0, {omega}, fem::ModalDamping{{0.001}});
  EXPECT_EQ(grid[0], 1.0);
  EXPECT_EQ(grid[grid.size() - 1], 80.0);
  for (const double peak : {4.0, 26.0}) {
    EXPECT_LT((grid.array() / peak - 1.0).abs().minCoeff(), 1e-12) << peak;
    EXPECT_GT(((grid.array() / peak - 1.0).abs() < 0.001).count(), 60) << peak;  // half-power half width
  }
  for (Eigen::Index i = 1; i < grid.size(); ++i) ASSERT_GT(grid[i], grid[i - 1]);
}

// The integral of |H|^2 of an oscillator over all frequencies is pi / (4 xi) w0 / K^2, in rad/s.
TEST(ResponseGrid, CarriesTheIntegralOverAResonance) {
  const double ratio = 0.001, peak = 4.0;
  const VectorXd grid =
      response_grid(0.01, 4000.0, {VectorXd::Constant(1, 2 * pi * peak)}, fem::ModalDamping{{ratio}});
  double integral = 0.0, before = 0.0;
  for (Eigen::Index i = 0; i < grid.size(); ++i) {
    const double r = grid[i] / peak;
    const double square = 1.0 / (std::pow(1 - r * r, 2) + std::pow(2 * ratio * r, 2));
    if (i > 0) integral += 0.5 * (square + before) * (grid[i] - grid[i - 1]);
    before = square;
  }
  EXPECT_NEAR(integral / (pi / (4 * ratio) * peak), 1.0, 1e-3);
}

TEST(MagnitudeComparison, TellsATenthEverywhereAndItsDecibels) {
  const VectorXd f = VectorXd::LinSpaced(50, 1.0, 9.0), full = f.cwiseInverse();
  const ResponseDifference found = compare_magnitudes(f, full, 0.9 * full);
  EXPECT_NEAR(found.relative, 0.1, 1e-14);
  EXPECT_NEAR(found.worst_db, 20 * std::log10(0.9), 1e-12);
  EXPECT_EQ(compare_magnitudes(f, full, full).relative, 0.0);
  VectorXd bump = full;
  bump[20] *= 3.0;
  EXPECT_EQ(compare_magnitudes(f, full, bump).worst_hz, f[20]);
}

}  // namespace
}  // namespace beamid::experiments::response_comparison_test
