#include "tests/filters/linear_model.hpp"

namespace beamid::test {

void LinearModel::transition(const Eigen::VectorXd& z, const Eigen::VectorXd&, Eigen::VectorXd& next) {
  next = a * z;
}

void LinearModel::linearised_transition(const Eigen::VectorXd& z, const Eigen::VectorXd&,
                                        Eigen::VectorXd& next, Eigen::MatrixXd& jacobian) {
  next = a * z;
  jacobian = a;
}

void LinearModel::output_jacobian(const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& jacobian) {
  jacobian = c;
}

LinearModel two_state_model() {
  LinearModel model;
  model.a.resize(2, 2), model.c.resize(1, 2);
  model.a << 1, 0.1, -0.2, 0.98;
  model.c << 1, 0;
  model.q = 1e-3 * Eigen::MatrixXd::Identity(2, 2);
  model.r = Eigen::MatrixXd::Constant(1, 1, 0.04);
  return model;
}

}  // namespace beamid::test
