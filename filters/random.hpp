// Random numbers that are the same on every machine.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

namespace beamid::filters {

// Normal numbers in bulk.

/// `count` standard normal numbers: those of RandomStream(seed, stream) to rounding, in a third of the time
/// where the processor has AVX2. The same on all processors of the same batch_instructions() (batch.hpp).
Eigen::VectorXd normal_noise(Eigen::Index count, std::uint64_t seed, std::uint64_t stream);

/// Philox 4x32-10 [salmon2011]: four random words for a counter under a key; no state to carry along.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

/// Independent numbers, one after another, from a seed; different streams of a seed are independent.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed, std::uint64_t stream = 0) : seed_(seed), stream_(stream) {}

  /// In (0, 1), from 53 bits.
  double uniform();
  /// Standard normal numbers (rows x columns), column after column: Box-Muller on Philox words.
  Eigen::MatrixXd normal(Eigen::Index rows, Eigen::Index columns);

 private:
  std::array<std::uint32_t, 4> words();

  std::uint64_t seed_, stream_, counter_ = 0;
};

// Random draws whose sample moments are exact.

/// k x N standard normal draws, then changed so that their rows have zero mean, the sample covariance I
/// (divisor N - 1), and no correlation with the rows of `others` (l x N) [pham2001], [hoteit2015]. Where N <
/// k + l + 1 there is no room for that: they are only centred, and the return says so by exact = false.
struct Draws {
  Eigen::MatrixXd values;  ///< k x N
  bool exact = false;
};
Draws exact_draws(RandomStream& random, Eigen::Index rows, Eigen::Index count, const Eigen::MatrixXd& others);

}  // namespace beamid::filters
