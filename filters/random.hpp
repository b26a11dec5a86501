// Random numbers that are the same on every machine.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace beamid::filters {

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

}  // namespace beamid::filters
