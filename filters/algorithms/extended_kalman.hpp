// Extended Kalman filter [jazwinski1970], for sizes known or unknown to the compiler and for any scalar:
//
//     predict   m = F(m),               P = J P J^T + Q                    J = dF/dz at the filtered mean
//     correct   S = H P H^T + R,        G = P H^T S^-1                     H = dh/dz at the predicted mean
//               m += G (y - h(m)),      P = (I - G H) P (I - G H)^T + G R G^T
//
// The last line is Joseph's form (covariance_steps.hpp).
#pragma once

#include "filters/algorithms/covariance_steps.hpp"
#include "filters/algorithms/weighing.hpp"

namespace beamid::filters::algorithms {

/// N states and P outputs, or Eigen::Dynamic; the model as in registered_filter.hpp.
template <class Scalar, int N, int P>
class ExtendedKalman {
 public:
  Vector<Scalar, N> mean;
  Matrix<Scalar, N> covariance;
  Weighing<Scalar, N, P> seen;  ///< of the last measurement

  template <class Model>
  void predict(Model& model) {
    model.linearised_transition(mean, next_, tangent_);
    mean.swap(next_);
    if constexpr (requires { Model::moving; })
      steps_.template carry<Model::moving>(tangent_, covariance);
    else
      steps_.carry(tangent_, covariance);
    if (model.process_noise().size() > 0) covariance += model.process_noise();
    mirror(covariance);
  }

  /// The innovation of y (p) and its gain; the estimate stays as it is.
  template <class Model>
  void look(Model& model, const Vector<Scalar, P>& y) {
    model.output(mean, expected_);
    model.output_jacobian(mean, sensor_);
    seen.innovation = y - expected_;
    multiply_transposed(covariance, sensor_, cross_);
    multiply(sensor_, cross_, seen.covariance);
    seen.covariance += model.output_noise();
    seen.weigh(cross_);
  }

  /// Takes in what look() saw.
  template <class Model>
  void update(Model& model) {
    mean.noalias() += seen.gain * seen.innovation;
    steps_.reduce(seen.gain, sensor_, model.output_noise(), covariance);
  }

 private:
  Vector<Scalar, N> next_;
  Vector<Scalar, P> expected_;
  Matrix<Scalar, N> tangent_;
  Matrix<Scalar, P, N> sensor_;
  Matrix<Scalar, N, P> cross_;
  CovarianceSteps<Scalar, N, P> steps_;
};

}  // namespace beamid::filters::algorithms
