// Compiled for AVX2 and FMA (CMakeLists.txt). Loops without branches, which the compiler turns into vectors;
// the logarithm, sine and cosine of these are those of the C library (libmvec), which <cmath> would announce
// under -ffast-math only. No template and no inline function: see batch_avx2.cpp.
#include "filters/normal_avx2.hpp"

#if defined(__AVX2__) && defined(__GLIBC__) && !defined(__clang__)

extern "C" {
__attribute__((simd("notinbranch"))) double log(double);
__attribute__((simd("notinbranch"))) double sin(double);
__attribute__((simd("notinbranch"))) double cos(double);
}

namespace beamid::filters::algorithms {
namespace {

constexpr int width = 128;  // pairs at a time: all tables stay in the first cache

using Words = std::uint32_t[4][width];

/// philox() of the counters from `first` on (random.cpp).
void words(std::uint64_t first, std::uint64_t seed, std::uint64_t stream, Words& w) {
  for (int i = 0; i < width; ++i) {
    w[0][i] = static_cast<std::uint32_t>(first + static_cast<std::uint64_t>(i));
    w[1][i] = static_cast<std::uint32_t>((first + static_cast<std::uint64_t>(i)) >> 32);
    w[2][i] = static_cast<std::uint32_t>(stream);
    w[3][i] = static_cast<std::uint32_t>(stream >> 32);
  }
  std::uint32_t key[2] = {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)};
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < width; ++i) {
      const std::uint64_t a = std::uint64_t{0xD2511F53u} * w[0][i], b = std::uint64_t{0xCD9E8D57u} * w[2][i];
      w[0][i] = static_cast<std::uint32_t>(b >> 32) ^ w[1][i] ^ key[0];
      w[1][i] = static_cast<std::uint32_t>(b);
      w[2][i] = static_cast<std::uint32_t>(a >> 32) ^ w[3][i] ^ key[1];
      w[3][i] = static_cast<std::uint32_t>(a);
    }
    key[0] += 0x9E3779B9u;
    key[1] += 0xBB67AE85u;
  }
}

/// (bits + 1/2) / 2^53 of the 53 upper bits, by signed numbers of 32 bits, for which there are instructions.
void fractions(const std::uint32_t* high, const std::uint32_t* low, double* result) {
  for (int i = 0; i < width; ++i) {
    const double upper = static_cast<double>(static_cast<std::int32_t>(high[i] ^ 0x80000000u)) + 0x1p31;
    const double lower = static_cast<double>(static_cast<std::int32_t>(low[i] >> 11)) + 0.5;
    result[i] = upper * 0x1p-32 + lower * 0x1p-53;
  }
}

}  // namespace

void normal_avx2(double* numbers, std::int64_t count, std::uint64_t seed, std::uint64_t stream) {
  constexpr double turn = 6.283185307179586476925;
  Words w;
  double u[width], v[width], first[width], second[width];
  for (std::int64_t done = 0; done < count; done += 2 * width) {
    words(static_cast<std::uint64_t>(done / 2), seed, stream, w);
    fractions(w[0], w[1], u);
    fractions(w[2], w[3], v);
    for (int i = 0; i < width; ++i) u[i] = __builtin_sqrt(-2.0 * log(u[i]));
    for (int i = 0; i < width; ++i) first[i] = u[i] * cos(turn * v[i]);
    for (int i = 0; i < width; ++i) second[i] = u[i] * sin(turn * v[i]);
    const std::int64_t pairs = (count - done) / 2 < width ? (count - done) / 2 : width;
    for (std::int64_t i = 0; i < pairs; ++i) {
      numbers[done + 2 * i] = first[i];
      numbers[done + 2 * i + 1] = second[i];
    }
  }
}
bool normal_compiled_for_avx2() {
  return true;
}

}  // namespace beamid::filters::algorithms

#else

namespace beamid::filters::algorithms {

void normal_avx2(double*, std::int64_t, std::uint64_t, std::uint64_t) {}
bool normal_compiled_for_avx2() {
  return false;
}

}  // namespace beamid::filters::algorithms

#endif
