// The equation that implicit one-step schemes share.
#pragma once

#include <Eigen/Core>

#include "filters/continuous_model.hpp"

namespace beamid::filters {

/// Newton solution of  z+ = z + dt f((1 - theta) z + theta z+, u(theta))  and its tangent
/// (I - theta dt J)^-1 (I + (1 - theta) dt J), J = df/dz at the point where f is taken.
///
/// theta = 1 is backward Euler, 1/2 the implicit midpoint rule. One object per thread: it keeps work space.
class ImplicitStep {
 public:
  explicit ImplicitStep(double theta) : theta_(theta) {}

  /// @throws std::runtime_error when Newton's method does not converge.
  void operator()(const ContinuousModel& model, const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                  double dt, Eigen::VectorXd& next, Eigen::MatrixXd* tangent);

 private:
  double theta_;
  Eigen::VectorXd point_, rate_, change_;
  Eigen::MatrixXd jacobian_, matrix_;
};

}  // namespace beamid::filters
