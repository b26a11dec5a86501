// Orthogonal triangularisation: another factor of the same covariance, without ever forming it.
#pragma once

#include "filters/algorithms/scalar.hpp"

namespace beamid::filters::algorithms {

/// Squares below this have left the normal numbers: a mode that has died out.
inline constexpr double nothing = 1e-280;

/// Householder reflections [golub2013, sec. 5.2] that turn F (n x m, m >= n) into F Theta = [L 0], so that
/// L L^T = F F^T, with L lower triangular and L_jj >= 0.
///
/// @param a F^T (m x n); its columns become the normals of the reflecting planes. What has been worked in is
/// set to zero, so that every sum runs over whole columns, whose length the compiler may know.
/// @param l L (n x n).
template <class Array, class Root>
void triangularise(Array& a, Root& l) {
  using Scalar = typename Array::Scalar;
  const Eigen::Index n = a.cols();
  l.resize(n, n);
#pragma GCC unroll 8
  for (Eigen::Index j = 0; j < n; ++j) {
    const Scalar first = a(j, j), square = a.col(j).squaredNorm(), length = square_root(square);
    const auto behind = first > Scalar(0.0);
    const Scalar far = length + magnitude(first), size = length * far;
    const auto some = size > Scalar(nothing);
    const Scalar scale = select(some, 1.0 / select(some, size, Scalar(1.0)), Scalar(0.0));
    const Scalar sign = select(behind, Scalar(-1.0), Scalar(1.0));  // the image of column j turned upwards
    a(j, j) = select(behind, far, -far);
    l(j, j) = length;
#pragma GCC unroll 8
    for (Eigen::Index i = j + 1; i < n; ++i) {
      const Scalar along = scale * a.col(j).dot(a.col(i));
      a.col(i) -= along * a.col(j);
      l(i, j) = sign * a(j, i);
      a(j, i) = 0.0;
      l(j, i) = 0.0;
    }
  }
}

}  // namespace beamid::filters::algorithms
