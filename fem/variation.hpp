// How a property varies along a segment of a beam.
#pragma once

#include <array>
#include <cstddef>

namespace beamid::fem {

/// A polynomial c0 + c1 s + ... + c4 s^4, s from 0 at the segment's root end to 1 at the other. Degree four
/// holds the second moment of area of a cone (height^4) and of a wedge (height^3).
class Variation {
 public:
  constexpr Variation(double constant = 0.0) : coefficients_{constant, 0, 0, 0, 0} {}

  /// From `start` at s = 0 to `end` at s = 1 along a straight line.
  static constexpr Variation linear(double start, double end) {
    Variation result(start);
    result.coefficients_[1] = end - start;
    return result;
  }

  constexpr double operator()(double s) const {
    double value = 0.0;
    for (std::size_t power = degree + 1; power-- > 0;) value = value * s + coefficients_[power];
    return value;
  }

  constexpr bool is_constant() const {
    for (std::size_t power = 1; power <= degree; ++power)
      if (coefficients_[power] != 0.0) return false;
    return true;
  }

  /// Mean over the segment, the integral from s = 0 to 1.
  constexpr double mean() const {
    double sum = 0.0;
    for (std::size_t power = 0; power <= degree; ++power)
      sum += coefficients_[power] / static_cast<double>(power + 1);
    return sum;
  }

  /// Product of two; terms above degree four must vanish and are dropped.
  friend constexpr Variation operator*(const Variation& a, const Variation& b) {
    Variation product;
    for (std::size_t i = 0; i <= degree; ++i)
      for (std::size_t j = 0; i + j <= degree; ++j)
        product.coefficients_[i + j] += a.coefficients_[i] * b.coefficients_[j];
    return product;
  }
  friend constexpr bool operator==(const Variation&, const Variation&) = default;

 private:
  static constexpr std::size_t degree = 4;
  std::array<double, degree + 1> coefficients_;
};

}  // namespace beamid::fem
