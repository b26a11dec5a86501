// m x'' + c x' + k x = f with k unknown, under a force that may be unknown too.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>

#include "filters/continuous_model.hpp"

namespace beamid::test {

/// z = [x, v; k]. Its sensors, in the order of the letters: x displacement, a acceleration.
class ForcedOscillator final : public filters::LinearMotion {
 public:
  static constexpr double mass = 2.0, damping = 3.0, stiffness = 800.0;

  explicit ForcedOscillator(std::string sensors = "xa") : sensors_(std::move(sensors)) {}

  Eigen::Index input_size() const override { return 1; }
  Eigen::Index motion_size() const override { return 2; }
  Eigen::Index parameter_size() const override { return 1; }
  std::vector<filters::Label> state_labels() const override { return {{"x", "m"}, {"v", "m/s"}, {"k", ""}}; }
  std::vector<filters::Label> output_labels() const override {
    std::vector<filters::Label> labels;
    for (const char one : sensors_) labels.push_back({std::string(1, one), one == 'x' ? "m" : "m/s2"});
    return labels;
  }
  void motion_matrix(const Eigen::VectorXd& z, Eigen::MatrixXd& a) const override {
    a = (Eigen::MatrixXd(2, 2) << 0.0, 1.0, -z[2] / mass, -damping / mass).finished();
  }
  void motion_matrix_derivative(const Eigen::VectorXd&, Eigen::Index, Eigen::MatrixXd& a) const override {
    a = (Eigen::MatrixXd(2, 2) << 0.0, 0.0, -1.0 / mass, 0.0).finished();
  }
  void input_matrix(const Eigen::VectorXd&, Eigen::MatrixXd& b) const override {
    b = Eigen::Vector2d(0.0, 1.0 / mass);
  }
  void output(const Eigen::VectorXd& z, const Eigen::VectorXd& u, Eigen::VectorXd& y) const override {
    y.resize(static_cast<Eigen::Index>(sensors_.size()));
    for (std::size_t i = 0; i < sensors_.size(); ++i)
      y[static_cast<Eigen::Index>(i)] =
          sensors_[i] == 'x' ? z[0] : (u[0] - damping * z[1] - z[2] * z[0]) / mass;
  }

 private:
  std::string sensors_;
};

}  // namespace beamid::test
