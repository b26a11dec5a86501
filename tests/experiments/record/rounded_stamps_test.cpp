// Stamps printed coarsely, of samples that are even. Oracle: the instants that were rounded.
#include "experiments/record/stamps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "filters/random.hpp"

namespace beamid::experiments::rounded_stamps_test {
namespace {

constexpr double rate = 243.66472, resolution = 1e-3;

std::vector<double> rounded(const std::vector<double>& times, double shift = 0.5) {
  std::vector<double> printed;
  for (const double time : times) printed.push_back(std::floor(time / resolution + shift) * resolution);
  return printed;
}

std::vector<double> even_instants(std::size_t count) {
  std::vector<double> times;
  for (std::size_t k = 0; k < count; ++k) times.push_back(0.0012 + static_cast<double>(k) / rate);
  return times;
}

TEST(RoundedStamps, GiveTheIntervalOfAllOfThem) {
  for (const double shift : {0.5, 0.0}) {  // rounded, cut off
    const auto found = without_rounding(rounded(even_instants(2437), shift), resolution);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->interval * rate, 1.0, 2e-6);  // by both ends 4e-5 off
    EXPECT_EQ(found->times.size(), 2437U);
  }
}

TEST(RoundedStamps, AreCountedWhereSamplesAreLost) {
  std::vector<double> times = even_instants(2437);
  times.erase(times.begin() + 700, times.begin() + 711);
  const auto found = without_rounding(rounded(times), resolution);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->interval * rate, 1.0, 2e-6);
  EXPECT_NEAR(found->times[1500], times[1500], 0.02 * resolution);
}

TEST(RoundedStamps, AreTakenAsTheyAreWhereTheyJitterOrAreExact) {
  std::vector<double> jittered = even_instants(2437);
  filters::RandomStream random(4);
  for (double& time : jittered) time += 0.3 / rate * (random.uniform() - 0.5);
  EXPECT_FALSE(without_rounding(rounded(jittered), resolution));
  std::vector<double> exact;
  for (int k = 0; k < 2500; ++k) exact.push_back(0.004 * k);
  EXPECT_FALSE(without_rounding(exact, resolution));
  EXPECT_FALSE(
      without_rounding(rounded(even_instants(2437)), 0.6 / rate));  // a lost sample would look the same
}

}  // namespace
}  // namespace beamid::experiments::rounded_stamps_test
