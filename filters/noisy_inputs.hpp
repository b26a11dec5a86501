// Inputs that were measured with noise.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "filters/discrete_model.hpp"

namespace beamid::filters {

/// A model whose inputs are read as u_k = u + e_k, e_k ~ N(0, R_u) white: the errors e_k (m) stand behind its
/// own state, so that the state is [z; e],
///
///     z_k+1 = F(z_k, u_k - e_k) + w,   e_k+1 ~ N(0, R_u),   y_k = h(z_k, u_k - e_k) + v
///
/// An error is held over its interval, whatever the path of the input: an interpolation spreads it over the
/// neighbouring intervals, which moves it by half of one and leaves the motion it makes, to (omega dt)^2 / 4,
/// the same. Outputs that show the input itself (a force at an accelerometer's place) share the error e_k,
/// which is why it is part of the state and not of Q alone.
class NoisyInputs final : public DiscreteModel {
 public:
  /// @param deviations of the inputs' noise (m)
  /// @throws std::invalid_argument when one is negative.
  NoisyInputs(std::unique_ptr<DiscreteModel> model, Eigen::VectorXd deviations);

  /// An estimate about z, and the first error as uncertain as any; back again.
  Gaussian with_errors(const Gaussian& estimate) const;
  Gaussian without_errors(const Gaussian& estimate) const;

  std::vector<Label> state_labels() const override;
  std::vector<Label> output_labels() const override { return model_->output_labels(); }
  const Eigen::MatrixXd& process_noise() const override { return noise_; }
  const Eigen::MatrixXd& output_noise() const override { return model_->output_noise(); }
  double interval() const override { return model_->interval(); }
  void set_interval(double dt) override;

  void transition(const Eigen::VectorXd& state, const Eigen::VectorXd& input, Eigen::VectorXd& next) override;
  void linearised_transition(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                             Eigen::VectorXd& next, Eigen::MatrixXd& jacobian) override;
  void output(const Eigen::VectorXd& state, const Eigen::VectorXd& input, Eigen::VectorXd& output) override;
  void output_jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                       Eigen::MatrixXd& jacobian) override;

 private:
  Eigen::Index own() const { return own_; }
  const Eigen::VectorXd& true_input(const Eigen::VectorXd& state, const Eigen::VectorXd& input);
  void take_noise();

  std::unique_ptr<DiscreteModel> model_;
  Eigen::VectorXd deviations_;
  Eigen::Index own_;
  Eigen::MatrixXd noise_, inner_;
  Eigen::VectorXd input_, moved_input_, inner_state_, moved_;
};

}  // namespace beamid::filters
