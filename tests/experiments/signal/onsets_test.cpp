// Hits and releases found in records that are simulated here, so that their instants are known.
#include "experiments/signal/onsets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments::onsets_test {
namespace {

constexpr double interval = 1e-3;

/// Noise, then a decay from each of the instants given, as a force history of two hits leaves behind.
Eigen::VectorXd hits(const std::vector<Eigen::Index>& at, double noise) {
  Eigen::VectorXd signal = 3.5 + (noise * standard_normal(6000, 7, 0)).array();
  for (const Eigen::Index start : at)
    for (Eigen::Index k = start; k < signal.size(); ++k) {
      const double t = interval * static_cast<double>(k - start);
      signal[k] += std::exp(-2 * t) * std::cos(2 * M_PI * 8 * t);
    }
  return signal;
}

// Oracle: the samples at which the decays were begun, and the noise that was added.
TEST(Onsets, AreFoundToTheSampleAlsoWhileTheBeamStillRings) {
  const Onsets found = find_onsets(hits({500, 3500}, 0.002), interval);
  EXPECT_THAT(found.samples, testing::ElementsAre(500, 3500));
  EXPECT_EQ(found.quiet, 500);
  EXPECT_NEAR(found.baseline, 3.5, 3 * 0.002 / std::sqrt(500));
  EXPECT_NEAR(found.noise, 0.002, 0.0003);
}

// Oracle: there is none.
TEST(Onsets, AreNotFoundInNoiseNorInMotionFromTheFirstSample) {
  EXPECT_TRUE(find_onsets(standard_normal(6000, 8, 0), interval).samples.empty());
  EXPECT_TRUE(find_onsets(hits({0}, 0).tail(5990), interval).samples.empty());
}

TEST(Onsets, RefuseASignalTooShort) {
  EXPECT_THROW(find_onsets(Eigen::VectorXd::Zero(15), interval), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::onsets_test
