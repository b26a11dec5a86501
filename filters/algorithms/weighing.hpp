// What an innovation weighs.
#pragma once

#include "filters/algorithms/scalar.hpp"

namespace beamid::filters::algorithms {

/// Innovation e = y - E[y], its covariance S = L L^T, the whitened w = L^-1 e and the gain G = cov(z, y)
/// S^-1.
///
/// Where S is not positive definite, `smallest_pivot` is not above zero, and what follows is no number.
template <class Scalar, int N, int P>
struct Weighing {
  Vector<Scalar, P> innovation;
  Matrix<Scalar, P> covariance;
  Matrix<Scalar, P> root;  ///< L, lower triangle
  Vector<Scalar, P> whitened;
  Matrix<Scalar, N, P> gain;
  Scalar smallest_pivot;     ///< of L, squared
  Scalar normalised_square;  ///< w^T w

  /// From the innovation and L.
  void whiten() {
    covariance.noalias() = root * root.transpose();
    whitened = innovation;
    normalised_square = 0.0;
    for (Eigen::Index j = 0; j < root.rows(); ++j) {
      for (Eigen::Index k = 0; k < j; ++k) whitened[j] -= root(j, k) * whitened[k];
      whitened[j] *= 1.0 / root(j, j);
      normalised_square += whitened[j] * whitened[j];
      const Scalar pivot = root(j, j) * root(j, j);
      smallest_pivot = j == 0 ? pivot : select(pivot >= smallest_pivot, smallest_pivot, pivot);
    }
  }

  /// From the innovation, S and cross = cov(z, y) (n x p).
  void weigh(const Matrix<Scalar, N, P>& cross) {
    const Eigen::Index p = covariance.rows(), n = cross.rows();
    root.resize(p, p);
    whitened.resize(p);
    gain.resize(n, p);
    normalised_square = 0.0;
    for (Eigen::Index j = 0; j < p; ++j) {
      Scalar pivot = covariance(j, j);
      for (Eigen::Index k = 0; k < j; ++k) pivot -= root(j, k) * root(j, k);
      smallest_pivot = j == 0 ? pivot : select(pivot >= smallest_pivot, smallest_pivot, pivot);
      root(j, j) = square_root(pivot);
      const Scalar inverse = 1.0 / root(j, j);
      for (Eigen::Index i = j + 1; i < p; ++i) {
        Scalar sum = covariance(i, j);
        for (Eigen::Index k = 0; k < j; ++k) sum -= root(i, k) * root(j, k);
        root(i, j) = sum * inverse;
      }
      whitened[j] = innovation[j];
      for (Eigen::Index k = 0; k < j; ++k) whitened[j] -= root(j, k) * whitened[k];
      whitened[j] *= inverse;
      normalised_square += whitened[j] * whitened[j];
      for (Eigen::Index i = 0; i < n; ++i) {
        Scalar sum = cross(i, j);  // cross L^-T, row by row
        for (Eigen::Index k = 0; k < j; ++k) sum -= root(j, k) * gain(i, k);
        gain(i, j) = sum * inverse;
      }
    }
    for (Eigen::Index j = p; j-- > 0;) {
      const Scalar inverse = 1.0 / root(j, j);
      for (Eigen::Index i = 0; i < n; ++i) {
        Scalar sum = gain(i, j);
        for (Eigen::Index k = j + 1; k < p; ++k) sum -= root(k, j) * gain(i, k);
        gain(i, j) = sum * inverse;
      }
    }
  }
};

}  // namespace beamid::filters::algorithms
