#include "experiments/signal/fast_length.hpp"

namespace beamid::experiments {

using Eigen::Index;

bool transforms_fast(Index length) {
  for (const Index prime : {2, 3, 5, 7})
    while (length % prime == 0) length /= prime;
  return length == 1;
}

Index fast_length_within(Index samples) {
  while (!transforms_fast(samples)) --samples;
  return samples;
}

Index even_fast_length_around(Index samples) {
  Index half = (samples + 1) / 2;
  while (!transforms_fast(half)) ++half;
  return 2 * half;
}

}  // namespace beamid::experiments
