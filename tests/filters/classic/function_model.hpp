// Models given by functions, for the classic cases.
#pragma once

#include <functional>
#include <string>

#include "filters/discrete_model.hpp"

namespace beamid::test {

/// z_k+1 = f(z_k, u_k) + w, y = h(z) + v from functions; Jacobians are central differences.
class FunctionModel final : public filters::DiscreteModel {
 public:
  using Function = std::function<void(const Eigen::VectorXd&, const Eigen::VectorXd&, Eigen::VectorXd&)>;

  FunctionModel(Function f, Function h, Eigen::MatrixXd process, Eigen::MatrixXd noise, double dt = 1.0)
      : f_(std::move(f)), h_(std::move(h)), q_(std::move(process)), r_(std::move(noise)), dt_(dt) {}

  std::vector<filters::Label> state_labels() const override { return std::vector<filters::Label>(q_.rows()); }
  std::vector<filters::Label> output_labels() const override;
  const Eigen::MatrixXd& process_noise() const override { return q_; }
  const Eigen::MatrixXd& output_noise() const override { return r_; }
  double interval() const override { return dt_; }
  void transition(const Eigen::VectorXd& z, const Eigen::VectorXd& u, Eigen::VectorXd& next) override;
  void output(const Eigen::VectorXd& z, const Eigen::VectorXd& u, Eigen::VectorXd& y) override;

 private:
  Function f_, h_;
  Eigen::MatrixXd q_, r_;
  double dt_;
};

}  // namespace beamid::test
