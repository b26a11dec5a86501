// The Gauss collocation method of two stages.
#pragma once

#include <Eigen/LU>

#include "filters/continuous_model.hpp"

namespace beamid::filters {

/// Newton solution of  k_i = f(z + dt sum_j a_ij k_j),  z+ = z + dt (k_1 + k_2)/2,
///
///     a = [ 1/4            1/4 - sqrt3/6 ]
///         [ 1/4 + sqrt3/6  1/4           ]
///
/// with the line of the input's mean and slope (StepInput) at the stages, and its tangent I + dt (k_1' +
/// k_2')/2, from (I - dt [a_ij J_i]) k' = [J_1; J_2] [hairer1996, ch. IV.5]. Fourth order. One object per
/// thread: it keeps work space.
class GaussStep {
 public:
  /// @throws std::runtime_error when Newton's method does not converge.
  void operator()(const ContinuousModel& model, const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                  double dt, Eigen::VectorXd& next, Eigen::MatrixXd* tangent);

 private:
  Eigen::VectorXd slopes_, residual_, change_, point_, rate_;
  Eigen::MatrixXd jacobians_, jacobian_, matrix_;
  Eigen::PartialPivLU<Eigen::MatrixXd> factor_;
};

}  // namespace beamid::filters
