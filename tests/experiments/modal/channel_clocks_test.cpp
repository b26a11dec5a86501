// Two channels of one decay, sampled by clocks of their own. Oracle: the modes that were simulated.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "experiments/modal/study/modal_study.hpp"
#include "filters/random.hpp"

namespace beamid::experiments::channel_clocks_test {
namespace {

constexpr double frequencies[] = {3.4555, 22.793}, ratio = 0.0045;

/// 8 s at 250 Hz, the second channel's clock slow by `drift`.
Record two_channels(double drift, std::uint64_t seed) {
  constexpr Eigen::Index count = 2000;
  Record record;
  record.time = Eigen::VectorXd::LinSpaced(count, 0.0, 0.004 * (count - 1));
  record.samples = 0.03 * filters::RandomStream(seed).normal(2, count);
  record.channels = {{Quantity::acceleration, "tip"}, {Quantity::acceleration, "middle"}};
  const double shapes[2][2] = {{5.0, 4.0}, {1.7, -2.8}};
  for (Eigen::Index k = 0; k < count; ++k)
    for (int c = 0; c < 2; ++c)
      for (int m = 0; m < 2; ++m) {
        const double t = record.time[k] * (c == 1 ? 1.0 + drift : 1.0),
                     w = 2.0 * std::numbers::pi * frequencies[m];
        record.samples(c, k) +=
            shapes[c][m] * std::exp(-ratio * w * t) * std::cos(w * std::sqrt(1.0 - ratio * ratio) * t + m);
      }
  return record;
}

class ChannelClocks : public testing::TestWithParam<double> {};

// 100 parts per million are 7 deviations of the second frequency; without the widening none was held.
TEST_P(ChannelClocks, ThatDifferAreToldAndCounted) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const RecordModes found = find_modes("two", two_channels(GetParam(), seed), false, {});
    ASSERT_EQ(found.modes.size(), 2U);
    EXPECT_THAT(texts(found.objections), testing::Contains(testing::HasSubstr("ppm faster than middle")));
    for (int m = 0; m < 2; ++m)
      EXPECT_LT(std::abs(found.modes[m].pole.frequency_hz() - frequencies[m]),
                1.96 * found.modes[m].pole.frequency_deviation_hz)
          << m << " " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Drifts, ChannelClocks, testing::Values(1e-4, 1e-3));

TEST(ChannelClocks, ThatAgreeAreNotSpokenOf) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const RecordModes found = find_modes("two", two_channels(0.0, seed), false, {});
    EXPECT_THAT(texts(found.objections), testing::Not(testing::Contains(testing::HasSubstr("ppm faster"))));
  }
}

}  // namespace
}  // namespace beamid::experiments::channel_clocks_test
