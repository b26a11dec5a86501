// z+ = A z + w, y = C z + v: where the Kalman filter is exact.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "filters/discrete_model.hpp"

namespace beamid::test {

/// A model of the matrices A, C, Q and R.
class LinearModel final : public filters::DiscreteModel {
 public:
  Eigen::MatrixXd a, c, q, r;

  std::vector<filters::Label> state_labels() const override { return std::vector<filters::Label>(a.rows()); }
  std::vector<filters::Label> output_labels() const override { return std::vector<filters::Label>(c.rows()); }
  const Eigen::MatrixXd& process_noise() const override { return q; }
  const Eigen::MatrixXd& output_noise() const override { return r; }
  double interval() const override { return 1.0; }
  void set_interval(double) override {}  // a step is a step, whatever the stamps say
  void transition(const Eigen::VectorXd& z, const Eigen::VectorXd&, Eigen::VectorXd& next) override {
    next = a * z;
  }
  void linearised_transition(const Eigen::VectorXd& z, const Eigen::VectorXd&, Eigen::VectorXd& next,
                             Eigen::MatrixXd& jacobian) override {
    next = a * z;
    jacobian = a;
  }
  void output(const Eigen::VectorXd& z, const Eigen::VectorXd&, Eigen::VectorXd& y) override { y = c * z; }
  void output_jacobian(const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& jacobian) override {
    jacobian = c;
  }
};

/// Two coupled states, the first of them observed.
inline LinearModel two_state_model() {
  LinearModel model;
  model.a = Eigen::Matrix2d{{1.0, 0.1}, {-0.2, 0.98}};
  model.c = Eigen::RowVector2d(1.0, 0.0);
  model.q = 1e-3 * Eigen::MatrixXd::Identity(2, 2);
  model.r = Eigen::MatrixXd::Constant(1, 1, 0.04);
  return model;
}

}  // namespace beamid::test
