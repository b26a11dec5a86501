// Every registered filter in turn, and the motion that the conformance tests run it on.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>

#include "filters/filter_run.hpp"
#include "tests/filters/oscillator.hpp"

namespace beamid::test {

inline constexpr double mass = 3.0, stiffness = 515.8, damping = 7.867;  // damping ratio 10 %

/// The oscillator of unknown stiffness and damping, sampled exactly.
std::unique_ptr<filters::DiscreteModel> joint_model(int outputs, double dt, double noise);

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
  void transition(const Eigen::VectorXd& z, const Eigen::VectorXd& u, Eigen::VectorXd& next) override;
  void linearised_transition(const Eigen::VectorXd& z, const Eigen::VectorXd& u, Eigen::VectorXd& next,
                             Eigen::MatrixXd& jacobian) override;
  void output(const Eigen::VectorXd& z, const Eigen::VectorXd& u, Eigen::VectorXd& y) override;
  void output_jacobian(const Eigen::VectorXd& z, const Eigen::VectorXd& u,
                       Eigen::MatrixXd& jacobian) override;

 private:
  static Eigen::VectorXd whole(const Eigen::VectorXd& z);

  std::unique_ptr<filters::DiscreteModel> joint_;
  Eigen::VectorXd value_;
  Eigen::MatrixXd tangent_, none_;
};

/// N samples of a free decay from [x0, 0], exact, with white noise of the given deviation on each output.
filters::Measurements decay(int outputs, Eigen::Index samples, double dt, double noise, std::mt19937& random,
                            double x0 = 0.012);

class EveryFilter : public testing::TestWithParam<std::string> {
 protected:
  static std::unique_ptr<filters::Filter> make(std::unique_ptr<filters::DiscreteModel> model,
                                               const filters::Options& options = {});
  static bool declares(const char* contract);
  static bool linear_only() { return declares(filters::contract::linear_models_only); }

  /// On the oscillator: [x, v, K, C], or [x, v] alone for filters of linear models.
  static std::unique_ptr<filters::Filter> oscillator(int outputs, double dt, double noise);
  static filters::Gaussian start(const Eigen::Vector4d& mean, const Eigen::Vector4d& variance);
};

}  // namespace beamid::test
