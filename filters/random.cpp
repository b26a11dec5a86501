#include "filters/random.hpp"

#include <cmath>
#include <numbers>

namespace beamid::filters {
namespace {

double fraction(std::uint32_t high, std::uint32_t low) {
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

std::array<std::uint32_t, 4> RandomStream::words() {
  const std::uint64_t here = counter_++;
  return philox({static_cast<std::uint32_t>(here), static_cast<std::uint32_t>(here >> 32),
                 static_cast<std::uint32_t>(stream_), static_cast<std::uint32_t>(stream_ >> 32)},
                {static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)});
}

double RandomStream::uniform() {
  const auto drawn = words();
  return fraction(drawn[0], drawn[1]);
}

Eigen::MatrixXd RandomStream::normal(Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd numbers(rows, columns);
  for (Eigen::Index i = 0; i < numbers.size(); i += 2) {
    const auto drawn = words();
    const double radius = std::sqrt(-2.0 * std::log(fraction(drawn[0], drawn[1])));
    const double angle = 2.0 * std::numbers::pi * fraction(drawn[2], drawn[3]);
    numbers.data()[i] = radius * std::cos(angle);
    if (i + 1 < numbers.size()) numbers.data()[i + 1] = radius * std::sin(angle);
  }
  return numbers;
}

}  // namespace beamid::filters
