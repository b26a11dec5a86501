// Lower roots of covariances.
#pragma once

#include <limits>
#include <type_traits>

#include "filters/algorithms/scalar.hpp"
#include "filters/innovation.hpp"

namespace beamid::filters::algorithms {

/// Lower L (n x n) with L L^T = A, column by column. A pivot that is zero, or below it by rounding, leaves
/// its column empty: a state known exactly. One that is further below, or no number, turns the lane into NaN.
/// A single double that meets anything but an empty column takes the careful way of filters::square_root(),
/// which need not give a triangle. @throws FilterFailure as that one does.
template <class Square>
void lower_root(const Square& a, Square& l) {
  using Scalar = typename Square::Scalar;
  constexpr double rounding = 1e-10;
  const Eigen::Index n = a.rows();
  l.resize(n, n);
  [[maybe_unused]] bool simple = true;
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = j; i < n; ++i) l(i, j) = a(i, j);
#pragma GCC unroll 8
  for (Eigen::Index j = 0; j < n; ++j) {  // L D^1/2 in the end; the pivots d_j need no square root
    const Scalar pivot = l(j, j);
    const auto positive = pivot > Scalar(0.0);
    const Scalar inverse = select(positive, 1.0 / select(positive, pivot, Scalar(1.0)), Scalar(0.0));
#pragma GCC unroll 8
    for (Eigen::Index i = j + 1; i < n; ++i) {
      const Scalar factor = inverse * l(i, j);
#pragma GCC unroll 8
      for (Eigen::Index k = j + 1; k <= i; ++k) l(i, k) -= factor * l(k, j);
    }
    const auto sound = pivot >= -rounding * magnitude(a(j, j));
    const Scalar scale =
        square_root(select(sound, inverse, Scalar(std::numeric_limits<double>::quiet_NaN())));
    if (!all(positive)) [[unlikely]]
      for (Eigen::Index i = j; i < n; ++i) simple = simple && all(l(i, j) == Scalar(0.0));
    for (Eigen::Index i = 0; i < j; ++i) l(i, j) = 0.0;
    for (Eigen::Index i = j; i < n; ++i) l(i, j) *= scale;
  }
  if constexpr (std::is_same_v<Scalar, double>)
    if (!simple) [[unlikely]] {
      Eigen::LLT<Eigen::MatrixXd> factor;
      l = filters::square_root(a, factor);
    }
}

}  // namespace beamid::filters::algorithms
