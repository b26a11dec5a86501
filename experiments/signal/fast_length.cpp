#include "experiments/signal/fast_length.hpp"

namespace beamid::experiments {

using Eigen::Index;

bool transforms_fast(Index length, Index largest_factor) {
  for (Index factor = 2; factor <= largest_factor; ++factor)
    while (length % factor == 0) length /= factor;
  return length == 1;
}

Index fast_length_within(Index samples, Index largest_factor) {
  while (!transforms_fast(samples, largest_factor)) --samples;
  return samples;
}

Index even_fast_length_around(Index samples) {
  Index half = (samples + 1) / 2;
  while (!transforms_fast(half)) ++half;
  return 2 * half;
}

}  // namespace beamid::experiments
