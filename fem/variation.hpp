// How a property varies along a segment of a beam.
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>

namespace beamid::fem {

/// A polynomial in s, from 0 at the segment's root end to 1 at the other, of degree four at most: enough for
/// the second moment of area of a cone (height^4) and of a wedge (width height^3). It is kept in Bernstein's
/// form [farouki2012],
///
///     sum_i b_i C(n, i) (1 - s)^(n - i) s^i,
///
/// whose terms are all positive where the b_i are: nothing cancels near a sharp tip, where b_n = 0.
class Variation {
 public:
  constexpr Variation(double constant = 0.0) : coefficients_{constant, 0, 0, 0, 0} {}

  /// From `start` at s = 0 to `end` at s = 1 along a straight line.
  static constexpr Variation linear(double start, double end) {
    Variation result(start);
    if (start == end) return result;
    result.degree_ = 1;
    result.coefficients_[1] = end;
    return result;
  }

  /// By de Casteljau's repeated means.
  constexpr double operator()(double s) const {
    std::array<double, most + 1> mean = coefficients_;
    for (std::size_t left = degree_; left > 0; --left)
      for (std::size_t i = 0; i < left; ++i) mean[i] = (1.0 - s) * mean[i] + s * mean[i + 1];
    return mean[0];
  }

  constexpr bool is_constant() const {
    for (std::size_t i = 1; i <= degree_; ++i)
      if (coefficients_[i] != coefficients_[0]) return false;
    return true;
  }

  /// Mean over the segment, the integral from s = 0 to 1.
  constexpr double mean() const {
    double sum = 0.0;
    for (std::size_t i = 0; i <= degree_; ++i) sum += coefficients_[i];
    return sum / static_cast<double>(degree_ + 1);
  }

  /// The part from s = begin to s = end, stretched over 0 to 1: the first n - i arguments of its polar form
  /// are begin, the others end [farouki2012].
  constexpr Variation part(double begin, double end) const {
    Variation result;
    result.degree_ = degree_;
    for (std::size_t i = 0; i <= degree_; ++i) {
      std::array<double, most + 1> mean = coefficients_;
      for (std::size_t left = degree_; left > 0; --left) {
        const double s = degree_ - left < degree_ - i ? begin : end;
        for (std::size_t k = 0; k < left; ++k) mean[k] = (1.0 - s) * mean[k] + s * mean[k + 1];
      }
      result.coefficients_[i] = mean[0];
    }
    return result;
  }

  /// @throws std::invalid_argument when the product's degree is above four.
  friend constexpr Variation operator*(const Variation& a, const Variation& b) {
    if (a.degree_ + b.degree_ > most)
      throw std::invalid_argument("a section's properties vary as a polynomial of degree above four");
    Variation product;
    product.degree_ = a.degree_ + b.degree_;
    for (std::size_t i = 0; i <= a.degree_; ++i)
      for (std::size_t j = 0; j <= b.degree_; ++j)
        product.coefficients_[i + j] += choose(a.degree_, i) * choose(b.degree_, j) /
                                        choose(product.degree_, i + j) * a.coefficients_[i] *
                                        b.coefficients_[j];
    return product;
  }
  friend constexpr bool operator==(const Variation&, const Variation&) = default;

 private:
  static constexpr std::size_t most = 4;

  static constexpr double choose(std::size_t n, std::size_t k) {
    double value = 1.0;
    for (std::size_t i = 0; i < k; ++i)
      value = value * static_cast<double>(n - i) / static_cast<double>(i + 1);
    return value;
  }

  std::size_t degree_ = 0;
  std::array<double, most + 1> coefficients_;  // b_0 ... b_n, then zeros
};

}  // namespace beamid::fem
