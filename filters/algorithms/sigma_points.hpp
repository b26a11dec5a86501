// Sigma points in difference form: what functions make of a Gaussian.
//
// Points m +- sqrt(c) L_i about the mean m of P = L L^T (n x n), each of weight W = 1/(2c). From the values
// f_i+-, and f_0 at the mean itself, come an odd and an even part and a shift,
//
//     o_i = (f_i+ - f_i-) / (2 sqrt c),   e_i = ((f_i+ - f_0) + (f_i- - f_0)) / (2 sqrt c),
//     s = sum e_i / sqrt c
//
//     mean f_0 + s,    covariance o o^T + e e^T + gamma s s^T,    cov(z, f) = L o^T
//
// c = alpha^2 (n + kappa), gamma = beta - alpha^2: the scaled unscented transform [julier2002], [wan2000].
// The centre's weight 1 - n/c is never formed, so that the weights sum to one exactly for any alpha, and
// gamma >= 0 makes the covariance a sum of squares. The cubature rule [arasaratnam2009] has c = n and no
// point at the mean: the middle of the first pair takes the place of f_0, and e_i - s / sqrt c that of e_i,
// with gamma = 0.
#pragma once

#include <cmath>

#include "filters/algorithms/scalar.hpp"

namespace beamid::filters::algorithms {

/// Where the points lie and what the mean's own weighs.
struct Spread {
  double reach = 1.0;   ///< sqrt c
  double centre = 0.0;  ///< gamma
  bool centred = true;  ///< whether f is asked for at the mean
};

/// Values of a function with M of them at the points: N ahead, N behind, and last, where asked for, the mean.
template <class Scalar, int M, int N>
using Points = Matrix<Scalar, M, N == Eigen::Dynamic ? Eigen::Dynamic : 2 * N + 1>;

/// The points themselves (n x 2n or 2n + 1).
template <class Mean, class Root, class Drawn>
void draw_points(const Mean& mean, const Root& root, const Spread& spread, Drawn& points) {
  const Eigen::Index n = mean.size();
  points.resize(n, Drawn::ColsAtCompileTime == Eigen::Dynamic && !spread.centred ? 2 * n : 2 * n + 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    points.col(i) = mean + spread.reach * root.col(i);
    points.col(n + i) = mean - spread.reach * root.col(i);
  }
  if (points.cols() > 2 * n) points.col(2 * n) = mean;
}

/// f_0 and s, o and e (M x N), of a function with M values.
template <class Scalar, int N, int M>
struct Moments {
  Vector<Scalar, M> origin, shift;
  Matrix<Scalar, M, N> odd, even;

  /// @param values f at the points.
  template <class Values>
  void gather(const Values& values, const Spread& spread) {
    const Eigen::Index n = values.cols() / 2;
    const double half = 0.5 / spread.reach, per_reach = 1.0 / spread.reach;
    odd.resize(values.rows(), n);
    even.resize(values.rows(), n);
    if (spread.centred)
      origin = values.col(2 * n);
    else
      origin = 0.5 * (values.col(0) + values.col(n));
    for (Eigen::Index i = 0; i < n; ++i) {
      odd.col(i) = half * (values.col(i) - values.col(n + i));
      if (spread.centred)  // nothing is lost for points close to the mean
        even.col(i) = half * ((values.col(i) - origin) + (values.col(n + i) - origin));
      else  // nor for points far away
        even.col(i) = per_reach * (0.5 * (values.col(i) + values.col(n + i)) - origin);
    }
    shift = even.col(0);
    for (Eigen::Index i = 1; i < n; ++i) shift += even.col(i);
    shift *= per_reach;
    if (!spread.centred)
      for (Eigen::Index i = 0; i < n; ++i) even.col(i) -= per_reach * shift;
  }
};

}  // namespace beamid::filters::algorithms
