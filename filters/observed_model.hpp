// The model as one step meets it.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "filters/discrete_model.hpp"

namespace beamid::filters {

// A discrete model whose interval may change.

/// Keeps the interval and the noise, which goes with it.
class TimedModel : public DiscreteModel {
 public:
  const Eigen::MatrixXd& process_noise() const final { return noise_.process; }
  const Eigen::MatrixXd& output_noise() const final { return noise_.output; }
  double interval() const final { return interval_; }
  void set_interval(double dt) final {
    if (dt == interval_) return;
    rescale(noise_, interval_, dt);
    interval_ = dt;
    interval_changed();
  }

 protected:
  TimedModel(double dt, Noise noise) : interval_(dt), noise_(std::move(noise)) {}

 private:
  /// What was prepared for the former interval is void.
  virtual void interval_changed() {}

  double interval_;
  Noise noise_;
};

/// Another model, of whose outputs only some were measured at this step, or whose noise is of this step only.
class ObservedModel final : public DiscreteModel {
 public:
  /// @throws std::invalid_argument when there is no model
  explicit ObservedModel(std::unique_ptr<DiscreteModel> model);

  /// Only these outputs exist, in increasing order (p' indices), until observe_all().
  void observe(std::vector<Eigen::Index> outputs);
  void observe_all();
  Eigen::Index all_outputs() const { return all_; }                        ///< p
  const std::vector<Eigen::Index>& observed() const { return observed_; }  ///< p'

  /// Noise that holds from now on in place of the model's own; nothing: the model's own again.
  /// @throws std::invalid_argument when R is not p x p, or Q not n x n.
  void set_output_noise(std::optional<Eigen::MatrixXd> noise);
  void set_process_noise(std::optional<Eigen::MatrixXd> noise);

  std::vector<Label> state_labels() const override { return model_->state_labels(); }
  std::vector<Label> output_labels() const override;
  const Eigen::MatrixXd& process_noise() const override;
  const Eigen::MatrixXd& output_noise() const override { return partial() ? some_noise_ : whole_noise(); }
  double interval() const override { return model_->interval(); }
  void set_interval(double dt) override;
  /// How often Q may have changed: who keeps a factor of it forms it anew when this has grown.
  int process_noise_changes() const { return process_noise_changes_; }

  void transition(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                  Eigen::VectorXd& next) override {
    model_->transition(state, input, next);
  }
  void linearised_transition(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                             Eigen::VectorXd& next, Eigen::MatrixXd& jacobian) override {
    model_->linearised_transition(state, input, next, jacobian);
  }
  void move(const Eigen::VectorXd& state, const Eigen::VectorXd& input, Eigen::VectorXd& next,
            Eigen::MatrixXd& directions) override {
    model_->move(state, input, next, directions);
  }
  void output(const Eigen::VectorXd& state, const Eigen::VectorXd& input, Eigen::VectorXd& output) override;
  void output_jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                       Eigen::MatrixXd& jacobian) override;

 private:
  bool partial() const { return static_cast<Eigen::Index>(observed_.size()) != all_; }
  const Eigen::MatrixXd& whole_noise() const {
    return output_noise_ ? *output_noise_ : model_->output_noise();
  }

  std::unique_ptr<DiscreteModel> model_;
  Eigen::Index all_ = 0;
  int process_noise_changes_ = 0;
  std::vector<Eigen::Index> observed_;
  std::optional<Eigen::MatrixXd> output_noise_, process_noise_;
  Eigen::MatrixXd some_noise_, whole_jacobian_;
  Eigen::VectorXd whole_output_;
};

}  // namespace beamid::filters
