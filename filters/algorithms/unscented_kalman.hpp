// Kalman filter on sigma points (sigma_points.hpp), for sizes known or unknown to the compiler and for any
// scalar. With o, e, s the moments of F, and o, e, t those of h, P = L L^T:
//
//     predict   m = F_0 + s,              P = o o^T + e e^T + gamma s s^T + Q
//     correct   E = e e^T + gamma t t^T + R,   S = o o^T + E,   G = L o^T S^-1
//               m += G (y - h_0 - t),     P = (L - G o)(L - G o)^T + G E G^T
//
// The last line is Joseph's form of the same linear correction: nothing is subtracted from a covariance.
#pragma once

#include "filters/algorithms/cholesky.hpp"
#include "filters/algorithms/products.hpp"
#include "filters/algorithms/sigma_points.hpp"
#include "filters/algorithms/weighing.hpp"

namespace beamid::filters::algorithms {

/// N states and P outputs, or Eigen::Dynamic; the model as in registered_filter.hpp.
template <class Scalar, int N, int P>
class UnscentedKalman {
 public:
  Vector<Scalar, N> mean;
  Matrix<Scalar, N> covariance;
  Weighing<Scalar, N, P> seen;  ///< of the last measurement

  explicit UnscentedKalman(const Spread& spread) : spread_(spread), centre_(std::sqrt(spread.centre)) {}

  template <class Model>
  void predict(Model& model) {
    draw();
    model.transitions(points_, moved_);
    moves_.gather(moved_, spread_);
    mean = moves_.origin + moves_.shift;
    multiply_transposed(moves_.odd, moves_.odd, covariance);
    multiply_transposed<Into::old_sum>(moves_.even, moves_.even, covariance);
    moves_.shift *= centre_;
    covariance.noalias() += moves_.shift * moves_.shift.transpose();
    if (model.process_noise().size() > 0) covariance += model.process_noise();
    mirror(covariance);
  }

  /// The innovation of y (p) and its gain; the estimate stays as it is.
  template <class Model>
  void look(Model& model, const Vector<Scalar, P>& y) {
    draw();
    model.outputs(points_, outputs_);
    sees_.gather(outputs_, spread_);
    seen.innovation = y - sees_.origin - sees_.shift;
    noise_ = model.output_noise();
    multiply_transposed<Into::old_sum>(sees_.even, sees_.even, noise_);
    sees_.shift *= centre_;
    noise_.noalias() += sees_.shift * sees_.shift.transpose();
    seen.covariance = noise_;
    multiply_transposed<Into::old_sum>(sees_.odd, sees_.odd, seen.covariance);
    multiply_transposed(root_, sees_.odd, cross_);
    seen.weigh(cross_);
  }

  /// Takes in what look() saw.
  template <class Model>
  void update(Model&) {
    mean.noalias() += seen.gain * seen.innovation;
    sees_.odd *= -1.0;
    multiply<Form::plain, Into::old_sum>(seen.gain, sees_.odd, root_);
    multiply_transposed(root_, root_, covariance);
    multiply(seen.gain, noise_, cross_);
    multiply_transposed<Into::old_sum>(cross_, seen.gain, covariance);
    mirror(covariance);
  }

 private:
  void draw() {
    lower_root(covariance, root_);
    draw_points(mean, root_, spread_, points_);
  }

  Spread spread_;
  double centre_;  // sqrt gamma
  Points<Scalar, N, N> points_, moved_;
  Points<Scalar, P, N> outputs_;
  Moments<Scalar, N, N> moves_;
  Moments<Scalar, N, P> sees_;
  Matrix<Scalar, N> root_;
  Matrix<Scalar, P> noise_;
  Matrix<Scalar, N, P> cross_;
};

}  // namespace beamid::filters::algorithms
