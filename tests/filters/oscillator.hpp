// The oscillator with unknown stiffness and damping that the filters are tested on: z = [x, v, K, C].
#pragma once

#include <memory>

#include "filters/continuous_model.hpp"

namespace beamid::test {

class Oscillator final : public filters::LinearMotion {
 public:
  /// @param outputs 1: displacement observed, 2: displacement and velocity. @param forced a force is the
  /// input.
  explicit Oscillator(double mass, int outputs = 1, bool forced = false)
      : mass_(mass), outputs_(outputs), forced_(forced) {}

  std::vector<filters::Label> state_labels() const override;
  std::vector<filters::Label> output_labels() const override;
  Eigen::Index input_size() const override { return forced_ ? 1 : 0; }
  Eigen::Index motion_size() const override { return 2; }
  Eigen::Index parameter_size() const override { return 2; }
  void motion_matrix(const Eigen::VectorXd& z, Eigen::MatrixXd& a) const override;
  void motion_matrix_derivative(const Eigen::VectorXd&, Eigen::Index j, Eigen::MatrixXd& a) const override;
  void input_matrix(const Eigen::VectorXd&, Eigen::MatrixXd& b) const override;
  void output(const Eigen::VectorXd& z, const Eigen::VectorXd&, Eigen::VectorXd& y) const override;
  void output_jacobian(const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::MatrixXd& h) const override;

 private:
  double mass_;
  int outputs_;
  bool forced_;
};

}  // namespace beamid::test
