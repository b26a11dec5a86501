#include "experiments/random.hpp"

#include <cmath>
#include <numbers>

namespace beamid::experiments {
namespace {

// A number in (0, 1), from 53 bits.
double uniform(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = (static_cast<std::uint64_t>(high) << 32 | low) >> 11;
  return (static_cast<double>(bits) + 0.5) * 0x1p-53;
}

}  // namespace

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t first = 0xD2511F53ull * counter[0], second = 0xCD9E8D57ull * counter[2];
    counter = {
        static_cast<std::uint32_t>(second >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(second),
        static_cast<std::uint32_t>(first >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(first)};
    key[0] += 0x9E3779B9u;
    key[1] += 0xBB67AE85u;
  }
  return counter;
}

Eigen::VectorXd standard_normal(Eigen::Index count, std::uint64_t seed, std::uint64_t stream) {
  const std::array<std::uint32_t, 2> key{static_cast<std::uint32_t>(seed),
                                         static_cast<std::uint32_t>(seed >> 32)};
  Eigen::VectorXd numbers(count);
  for (Eigen::Index i = 0; i < count; i += 2) {
    const auto pair = static_cast<std::uint64_t>(i / 2);
    const auto words = philox({static_cast<std::uint32_t>(pair), static_cast<std::uint32_t>(pair >> 32),
                               static_cast<std::uint32_t>(stream), static_cast<std::uint32_t>(stream >> 32)},
                              key);
    const double radius = std::sqrt(-2.0 * std::log(uniform(words[0], words[1])));
    const double angle = 2.0 * std::numbers::pi * uniform(words[2], words[3]);
    numbers[i] = radius * std::cos(angle);
    if (i + 1 < count) numbers[i + 1] = radius * std::sin(angle);
  }
  return numbers;
}

}  // namespace beamid::experiments
