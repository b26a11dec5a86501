#include "experiments/models/motion/storey_step.hpp"

#include <cmath>

#include "filters/step_input.hpp"
#include "filters/timed_model.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class StoreyStep final : public filters::TimedModel {
 public:
  StoreyStep(std::shared_ptr<const StoreyMotion> motion, double dt, filters::Noise noise)
      : TimedModel(dt, std::move(noise)), motion_(std::move(motion)) {
    prepare();
  }

  std::vector<filters::Label> state_labels() const override { return motion_->state_labels(); }
  std::vector<filters::Label> output_labels() const override { return motion_->output_labels(); }

  void transition(const VectorXd& state, const VectorXd& input, VectorXd& next) override {
    step(state, input, next, nullptr);
  }
  void linearised_transition(const VectorXd& state, const VectorXd& input, VectorXd& next,
                             MatrixXd& jacobian) override {
    jacobian.setIdentity(motion_->size(), motion_->size());
    step(state, input, next, &jacobian);
  }
  void move(const VectorXd& state, const VectorXd& input, VectorXd& next, MatrixXd& directions) override {
    step(state, input, next, &directions);
  }
  void output(const VectorXd& state, const VectorXd& input, VectorXd& output) override {
    motion_->output(state, now(input), output);
  }
  void output_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) override {
    motion_->output_jacobian(state, now(input), jacobian);
  }

 private:
  std::shared_ptr<const StoreyMotion> motion_;
  int parts_ = 1;
  StoreyMotion::Equations equations_;
  VectorXd rate_, point_;
  MatrixXd jacobian_, slope_, point_directions_;

  void interval_changed() override { prepare(); }
  void prepare() {
    constexpr double largest_turn = 0.15;  // [rad]
    parts_ = std::max(1, static_cast<int>(std::ceil(motion_->floors().frequencies().maxCoeff() * interval() /
                                                    largest_turn)));
  }

  VectorXd now(const VectorXd& path) const { return path.head(std::min(path.size(), motion_->input_size())); }

  void step(const VectorXd& state, const VectorXd& input, VectorXd& next, MatrixXd* directions) {
    const filters::StepInput path(input, motion_->input_size());
    motion_->evaluate(state, directions != nullptr, equations_);
    next = state;
    for (int i = 0; i < parts_; ++i) part(path, i, next, directions);
  }

  // k_i = f(z + a_i h k_i-1), a = 0, 1/2, 1/2, 1;  z+ = z + h sum b_i k_i, b = 1/6, 1/3, 1/3, 1/6; the same
  // of directions, whose rates are J (D + a_i h D'_i-1). Only motion and slips have rates.
  void part(const filters::StepInput& path, int number, VectorXd& z, MatrixXd* directions) {
    constexpr double node[4] = {0.0, 0.5, 0.5, 1.0};
    constexpr double weight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    const double h = interval() / parts_;
    const Index motion = motion_->floors().layout().motion, slips_at = motion_->slips_at(),
                slips = motion_->slips();
    const VectorXd begin = z;
    MatrixXd begin_directions;
    rate_.setZero(z.size());
    if (directions) {
      begin_directions = *directions;
      slope_.setZero(motion + slips, directions->cols());
    }
    for (int i = 0; i < 4; ++i) {
      point_ = begin + node[i] * h * rate_;
      const VectorXd input = path.size() > 0 ? path.at((number + node[i]) / parts_) : VectorXd();
      motion_->rate(equations_, point_, input, rate_);
      z += weight[i] * h * rate_;
      if (!directions) continue;
      motion_->rate_jacobian(equations_, point_, input, jacobian_);
      point_directions_ = begin_directions;
      point_directions_.topRows(motion) += node[i] * h * slope_.topRows(motion);
      point_directions_.middleRows(slips_at, slips) += node[i] * h * slope_.bottomRows(slips);
      slope_.topRows(motion).noalias() = jacobian_.topRows(motion) * point_directions_;
      slope_.bottomRows(slips).noalias() = jacobian_.middleRows(slips_at, slips) * point_directions_;
      directions->topRows(motion) += weight[i] * h * slope_.topRows(motion);
      directions->middleRows(slips_at, slips) += weight[i] * h * slope_.bottomRows(slips);
    }
  }
};

}  // namespace

std::unique_ptr<filters::DiscreteModel> storey_step(std::shared_ptr<const StoreyMotion> motion, double dt,
                                                    const std::string& scheme, const filters::Noise& noise) {
  if (scheme != "runge_kutta_4") return nullptr;
  return std::make_unique<StoreyStep>(std::move(motion), dt, noise);
}

}  // namespace beamid::experiments
