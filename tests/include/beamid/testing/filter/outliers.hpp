// Readings that are plainly wrong.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "beamid/testing/every_filter.hpp"

namespace beamid::test::outliers {

using Eigen::Index, Eigen::Vector4d;

inline const Vector4d mean(0.012, 0.0, 500.0, 9.0), variance(1e-6, 1e-4, 4e2, 4.0);

TEST_P(EveryFilter, IsNotMovedByOneOutlierIfItIsRobust) {
  // Oracle: the same record without the outlier, of a thousand deviations, early or late.
  if (!declares(filters::contract::robust)) GTEST_SKIP() << "not promised";
  std::mt19937 random(43);
  const auto clean = decay(2, 1000, 2e-3, 1e-4, random);
  const auto expected = run(*oscillator(2, 2e-3, 1e-4), start(mean, variance), clean);
  for (const Index place : {0, 20, 700}) {
    auto record = clean;
    record.outputs(0, place) += 0.1;
    const auto found = run(*oscillator(2, 2e-3, 1e-4), start(mean, variance), record);
    ASSERT_FALSE(found.failure);
    const Vector4d moved = (found.last.mean - expected.last.mean).cwiseQuotient(expected.last.deviations());
    EXPECT_LT(moved.cwiseAbs().maxCoeff(), 0.5) << place;
  }
}

TEST_P(EveryFilter, FindsTheTruthAmongOutliersIfItIsRobust) {
  // Oracle: the truth, within four of its deviations; those without outliers, since outliers tell nothing.
  // One reading in twenty is off by up to 200 deviations.
  if (!declares(filters::contract::robust)) GTEST_SKIP() << "not promised";
  for (unsigned seed = 1; seed <= 5; ++seed) {
    std::mt19937 random(seed);
    auto record = decay(2, 1000, 2e-3, 1e-4, random);
    std::uniform_real_distribution<double> wrong(-0.02, 0.02);
    for (Index k = 0; k < 1000; ++k)
      for (Index i = 0; i < 2; ++i)
        if (random() % 20 == 0) record.outputs(i, k) += wrong(random);
    const auto found = run(*oscillator(2, 2e-3, 1e-4), start(mean, variance), record);
    ASSERT_FALSE(found.failure);
    const Eigen::VectorXd deviation = found.last.deviations();
    EXPECT_NEAR(found.last.mean[2], stiffness, 4.0 * deviation[2]) << seed;
    EXPECT_NEAR(found.last.mean[3], damping, 4.0 * deviation[3]) << seed;
    EXPECT_LT(deviation[2], 1e-3 * stiffness);  // and has learnt from the others
    EXPECT_FALSE(found.remarks.empty());
  }
}

}  // namespace beamid::test::outliers
