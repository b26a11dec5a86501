// Steps that filters with Jacobians share.
#pragma once

#include <Eigen/Cholesky>

#include "filters/algorithms/covariance_steps.hpp"
#include "filters/filter.hpp"

namespace beamid::filters {

/// The extended Kalman filter's two steps on an estimate's covariance, and their work space [jazwinski1970].
class LinearisedStep {
 public:
  /// P = J P J^T + Q, J (n x n); Q may be empty: none. @throws FilterFailure
  void predict(Gaussian& estimate, const Eigen::MatrixXd& tangent, const Eigen::MatrixXd& process_noise);

  /// S = H P H^T + R, G = P H^T S^-1, P = (I - G H) P (I - G H)^T + G R G^T in Joseph's form [bucy1968].
  /// Moves the mean by G correction.innovation, and fills in what else the correction says.
  ///
  /// @param sensor H (p x n). @param noise R (p x p). @throws FilterFailure
  void correct(Gaussian& estimate, const Eigen::MatrixXd& sensor, const Eigen::MatrixXd& noise,
               Correction& correction);

  const Eigen::MatrixXd& gain() const { return gain_; }  ///< G of the last correction (n x p)

 private:
  algorithms::CovarianceSteps<double, Eigen::Dynamic, Eigen::Dynamic> steps_;
  Eigen::MatrixXd cross_, gain_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

/// An estimate that fits the model, with its covariance as a matrix alone. @throws std::invalid_argument
Gaussian as_matrix(const Gaussian& estimate, const DiscreteModel& model);

}  // namespace beamid::filters
