#include "filters/normal_noise.hpp"

#include "filters/normal_avx2.hpp"
#include "filters/random.hpp"

namespace beamid::filters {

Eigen::VectorXd normal_noise(Eigen::Index count, std::uint64_t seed, std::uint64_t stream) {
  static const bool avx2 = algorithms::normal_compiled_for_avx2() && __builtin_cpu_supports("avx2") &&
                           __builtin_cpu_supports("fma");
  if (!avx2) return RandomStream(seed, stream).normal(count, 1);
  Eigen::VectorXd numbers(count + count % 2);
  algorithms::normal_avx2(numbers.data(), numbers.size(), seed, stream);
  return numbers.head(count);
}

}  // namespace beamid::filters
