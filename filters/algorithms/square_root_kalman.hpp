// Kalman filter on sigma points (sigma_points.hpp) that carries a lower root of the covariance, P = L L^T
// [vandermerwe2001], [arasaratnam2009], for sizes known or unknown to the compiler and for any scalar.
//
// With o, e, s the moments of F, and o, e, t those of h, both steps are orthogonal triangularisations:
//
//     predict   [o  e  sqrt(gamma) s  Q^1/2]  ->  [L 0]
//     correct   [e  sqrt(gamma) t  R^1/2]  ->  [W 0],      [o W]      [S^1/2  0]
//                                                          [L 0]  ->  [X      L]
//               m += X w,   w = S^-1/2 (y - h_0 - t)
//
// The second array is the square-root filter's [kaminski1971] on the linear map that the points
// see. The covariance is positive by construction, no root is downdated, and no gain is multiplied and
// subtracted: a prior of 1e24 leaves the variance of a measurement, 0.04, to its last digit.
#pragma once

#include "filters/algorithms/scalar.hpp"
#include "filters/algorithms/sigma_points.hpp"
#include "filters/algorithms/weighing.hpp"

namespace beamid::filters::algorithms {

// Orthogonal triangularisation: another factor of the same covariance, without ever forming it.

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

/// N states and P outputs, or Eigen::Dynamic; the model as in registered_filter.hpp.
template <class Scalar, int N, int P>
class SquareRootKalman {
 public:
  Vector<Scalar, N> mean;
  Matrix<Scalar, N> root;       ///< L
  Weighing<Scalar, N, P> seen;  ///< of the last measurement

  explicit SquareRootKalman(const Spread& spread) : spread_(spread), centre_(std::sqrt(spread.centre)) {}

  template <class Model>
  void predict(Model& model) {
    draw_points(mean, root, spread_, points_);
    model.transitions(points_, moved_);
    moves_.gather(moved_, spread_);
    mean = moves_.origin + moves_.shift;
    const Eigen::Index n = mean.size();
    const auto& noise = model.process_noise_root();
    if constexpr (N == Eigen::Dynamic) move_.resize(2 * n + 1 + noise.cols(), n);
    move_.topRows(n) = moves_.odd.transpose();
    move_.middleRows(n, n) = moves_.even.transpose();
    move_.row(2 * n) = centre_ * moves_.shift.transpose();
    move_.bottomRows(noise.cols()) = noise.transpose();
    triangularise(move_, root);
  }

  /// The innovation of y (p), and what it makes of the root; the estimate stays as it is.
  template <class Model>
  void look(Model& model, const Vector<Scalar, P>& y) {
    draw_points(mean, root, spread_, points_);
    model.outputs(points_, outputs_);
    sees_.gather(outputs_, spread_);
    seen.innovation = y - sees_.origin - sees_.shift;
    const Eigen::Index n = mean.size(), p = y.size();
    if constexpr (P == Eigen::Dynamic) noise_.resize(n + 1 + p, p), joint_.resize(n + p, n + p);
    noise_.topRows(n) = sees_.even.transpose();
    noise_.row(n) = centre_ * sees_.shift.transpose();
    noise_.bottomRows(p) = model.output_noise_root().transpose();
    triangularise(noise_, seen.root);
    joint_.topLeftCorner(n, p) = sees_.odd.transpose();
    joint_.bottomLeftCorner(p, p) = seen.root.transpose();
    joint_.topRightCorner(n, n) = root.transpose();
    joint_.bottomRightCorner(p, n).setZero();
    triangularise(joint_, corrected_);
    seen.root = corrected_.topLeftCorner(p, p);
    seen.whiten();
  }

  /// Takes in what look() saw.
  template <class Model>
  void update(Model&) {
    const Eigen::Index n = mean.size(), p = seen.innovation.size();
    mean.noalias() += corrected_.bottomLeftCorner(n, p) * seen.whitened;
    root = corrected_.bottomRightCorner(n, n);
  }

 private:
  static constexpr int sum(int a, int b) { return a < 0 || b < 0 ? Eigen::Dynamic : a + b; }
  static constexpr int moved_columns = sum(sum(N, N), sum(N, 1));

  Spread spread_;
  double centre_;  // sqrt gamma
  Points<Scalar, N, N> points_, moved_;
  Points<Scalar, P, N> outputs_;
  Moments<Scalar, N, N> moves_;
  Moments<Scalar, N, P> sees_;
  Matrix<Scalar, moved_columns, N> move_;
  Matrix<Scalar, sum(N, sum(P, 1)), P> noise_;
  Matrix<Scalar, sum(N, P)> joint_, corrected_;
};

}  // namespace beamid::filters::algorithms
