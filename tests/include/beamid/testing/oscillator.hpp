// The oscillator with unknown stiffness and damping that filters are tested on: z = [x, v, K, C].
#pragma once

#include <Eigen/Core>
#include <vector>

#include "filters/continuous_model.hpp"

namespace beamid::test {

/// M x'' + C x' + K x = F; its state is z.
class Oscillator final : public filters::LinearMotion {
 public:
  /// @param mass [kg]. @param outputs 1: displacement observed, 2: displacement and velocity.
  /// @param forced a force is the input.
  explicit Oscillator(double mass, int outputs = 1, bool forced = false)
      : mass_(mass), outputs_(outputs), forced_(forced) {}

  std::vector<filters::Label> state_labels() const override {
    return {{"x", "m"}, {"v", "m/s"}, {"K", "N/m"}, {"C", "N s/m"}};
  }
  std::vector<filters::Label> output_labels() const override {
    std::vector<filters::Label> labels{{"x", "m"}, {"v", "m/s"}};
    labels.resize(outputs_);
    return labels;
  }
  Eigen::Index input_size() const override { return forced_ ? 1 : 0; }
  Eigen::Index motion_size() const override { return 2; }
  Eigen::Index parameter_size() const override { return 2; }
  void motion_matrix(const Eigen::VectorXd& z, Eigen::MatrixXd& a) const override {
    a.resize(2, 2);
    a << 0.0, 1.0, -z[2] / mass_, -z[3] / mass_;
  }
  void motion_matrix_derivative(const Eigen::VectorXd&, Eigen::Index j, Eigen::MatrixXd& a) const override {
    a.setZero(2, 2);
    a(1, j) = -1.0 / mass_;
  }
  void input_matrix(const Eigen::VectorXd&, Eigen::MatrixXd& b) const override {
    b.setZero(2, input_size());
    if (forced_) b(1, 0) = 1.0 / mass_;
  }
  void output(const Eigen::VectorXd& z, const Eigen::VectorXd&, Eigen::VectorXd& y) const override {
    y = z.head(outputs_);
  }
  void output_jacobian(const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& h) const override {
    h.setZero(outputs_, 4);
    h.leftCols(outputs_).setIdentity();
  }

 private:
  double mass_;
  int outputs_;
  bool forced_;
};

}  // namespace beamid::test
