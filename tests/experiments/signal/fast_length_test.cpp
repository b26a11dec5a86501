// Oracle: factors, tried one by one.
#include "experiments/signal/toolbox.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace beamid::experiments::fast_length_test {
namespace {

using Eigen::Index;

Index largest_factor(Index n) {
  Index largest = 1;
  for (Index factor = 2; n > 1; ++factor)
    for (; n % factor == 0; n /= factor) largest = factor;
  return largest;
}

TEST(FastLength, IsTheNearestWithoutFactorsAboveSeven) {
  std::vector<Index> fast;
  for (Index n = 1; n <= 5000; ++n) {
    EXPECT_EQ(transforms_fast(n), largest_factor(n) <= 7) << n;
    if (largest_factor(n) <= 7) fast.push_back(n);
  }
  for (Index n = 1; n <= 4000; ++n) {
    EXPECT_EQ(fast_length_within(n), *std::prev(std::upper_bound(fast.begin(), fast.end(), n))) << n;
    EXPECT_EQ(even_fast_length_around(n),
              *std::find_if(fast.begin(), fast.end(), [&](Index one) { return one >= n && one % 2 == 0; }))
        << n;
  }
}

}  // namespace
}  // namespace beamid::experiments::fast_length_test
