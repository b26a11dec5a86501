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

#include "filters/algorithms/sigma_points.hpp"
#include "filters/algorithms/triangularise.hpp"
#include "filters/algorithms/weighing.hpp"

namespace beamid::filters::algorithms {

/// N states and P outputs, or Eigen::Dynamic; the model as in observed.hpp.
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
