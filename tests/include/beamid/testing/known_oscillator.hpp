// The motion that filters are held to their contracts on: a free decay of an oscillator, sampled exactly.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <random>
#include <vector>

#include "beamid/testing/oscillator.hpp"
#include "filters/discrete_model.hpp"
#include "filters/measurements.hpp"

namespace beamid::test {

inline constexpr double mass = 3.0, stiffness = 515.8, damping = 7.867;  // damping ratio 10 %

/// The oscillator of unknown stiffness and damping, sampled exactly.
inline std::unique_ptr<filters::DiscreteModel> joint_model(int outputs, double dt, double noise) {
  return filters::discretise(std::make_shared<Oscillator>(mass, outputs), dt, "exponential",
                             {{}, noise * noise * Eigen::MatrixXd::Identity(outputs, outputs)});
}

/// The same with stiffness and damping known: z = [x, v], linear.
class KnownOscillator final : public filters::DiscreteModel {
 public:
  KnownOscillator(int outputs, double dt, double noise) : joint_(joint_model(outputs, dt, noise)) {}

  std::vector<filters::Label> state_labels() const override { return {{"x", "m"}, {"v", "m/s"}}; }
  std::vector<filters::Label> output_labels() const override { return joint_->output_labels(); }
  const Eigen::MatrixXd& process_noise() const override { return none_; }
  const Eigen::MatrixXd& output_noise() const override { return joint_->output_noise(); }
  double interval() const override { return joint_->interval(); }
  void set_interval(double dt) override { joint_->set_interval(dt); }
  void transition(const Eigen::VectorXd& z, const Eigen::VectorXd& u, Eigen::VectorXd& next) override {
    joint_->transition(whole(z), u, value_);
    next = value_.head(2);
  }
  void linearised_transition(const Eigen::VectorXd& z, const Eigen::VectorXd& u, Eigen::VectorXd& next,
                             Eigen::MatrixXd& jacobian) override {
    joint_->linearised_transition(whole(z), u, value_, tangent_);
    next = value_.head(2);
    jacobian = tangent_.topLeftCorner(2, 2);
  }
  void output(const Eigen::VectorXd& z, const Eigen::VectorXd& u, Eigen::VectorXd& y) override {
    joint_->output(whole(z), u, y);
  }
  void output_jacobian(const Eigen::VectorXd& z, const Eigen::VectorXd& u,
                       Eigen::MatrixXd& jacobian) override {
    joint_->output_jacobian(whole(z), u, tangent_);
    jacobian = tangent_.leftCols(2);
  }

 private:
  static Eigen::VectorXd whole(const Eigen::VectorXd& z) {
    return Eigen::Vector4d(z[0], z[1], stiffness, damping);
  }

  std::unique_ptr<filters::DiscreteModel> joint_;
  Eigen::VectorXd value_;
  Eigen::MatrixXd tangent_, none_;
};

/// N samples of a free decay from [x0, 0], exact, with white noise of this standard deviation on each output.
inline filters::Measurements decay(int outputs, Eigen::Index samples, double dt, double noise,
                                   std::mt19937& random, double x0 = 0.012) {
  const auto model = joint_model(outputs, dt, 1.0);
  std::normal_distribution<double> normal;
  filters::Measurements record{Eigen::VectorXd(samples), Eigen::MatrixXd(outputs, samples), {}};
  Eigen::VectorXd z = Eigen::Vector4d(x0, 0.0, stiffness, damping), next;
  for (Eigen::Index k = 0; k < samples; ++k) {
    record.time[k] = static_cast<double>(k) * dt;
    for (Eigen::Index i = 0; i < outputs; ++i) record.outputs(i, k) = z[i] + noise * normal(random);
    model->transition(z, {}, next);
    z.swap(next);
  }
  return record;
}

}  // namespace beamid::test
