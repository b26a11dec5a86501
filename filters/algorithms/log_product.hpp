// Logarithms of long products.
#pragma once

#include "filters/algorithms/lanes.hpp"

namespace beamid::filters::algorithms {

/// Product of many positive normal numbers per lane, as mantissa in [1, 2) and exponent: one logarithm at the
/// end in place of one per factor, and no overflow on the way.
template <class Scalar>
class LogProduct;

template <int W, class Instructions>
class LogProduct<Lanes<W, Instructions>> {
 public:
  using Scalar = Lanes<W, Instructions>;
  using Bits = typename Scalar::Bits;

  void multiply(const Scalar& factor) {
    const Bits bits = std::bit_cast<Bits>((mantissa_ * factor).values);
    exponent_ += (bits >> 52) - 1023;
    mantissa_ =
        std::bit_cast<typename Scalar::Values>((bits & 0x000f'ffff'ffff'ffff) | 0x3ff0'0000'0000'0000);
  }
  double mantissa(int lane) const { return mantissa_[lane]; }
  std::int64_t exponent(int lane) const { return exponent_[lane]; }

 private:
  Scalar mantissa_ = 1.0;
  Bits exponent_ = Bits{};
};

}  // namespace beamid::filters::algorithms
