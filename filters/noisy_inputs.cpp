#include "filters/noisy_inputs.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

NoisyInputs::NoisyInputs(std::unique_ptr<DiscreteModel> model, VectorXd deviations)
    : model_(std::move(model)),
      deviations_(std::move(deviations)),
      own_(static_cast<Index>(model_->state_labels().size())) {
  for (const double deviation : deviations_)
    if (!(deviation >= 0.0 && std::isfinite(deviation)))
      throw std::invalid_argument("the noise of an input is " + std::to_string(deviation) +
                                  "; expected a number of at least 0");
  take_noise();
}

// An error comes anew with every interval, however long: Q of the errors does not grow with it.
void NoisyInputs::take_noise() {
  const Index m = deviations_.size();
  noise_.setZero(own() + m, own() + m);
  if (model_->process_noise().size() > 0) noise_.topLeftCorner(own(), own()) = model_->process_noise();
  noise_.bottomRightCorner(m, m) = deviations_.cwiseAbs2().asDiagonal();
}

void NoisyInputs::set_interval(double dt) {
  model_->set_interval(dt);
  take_noise();
}

Gaussian NoisyInputs::with_errors(const Gaussian& estimate) const {
  const Index m = deviations_.size();
  Gaussian result{VectorXd::Zero(own() + m), MatrixXd::Zero(own() + m, own() + m), {}};
  result.mean.head(own()) = estimate.mean;
  result.covariance.topLeftCorner(own(), own()) =
      estimate.covariance.size() > 0 ? estimate.covariance
                                     : MatrixXd(estimate.factor * estimate.factor.transpose());
  result.covariance.bottomRightCorner(m, m) = deviations_.cwiseAbs2().asDiagonal();
  return result;
}

Gaussian NoisyInputs::without_errors(const Gaussian& estimate) const {
  if (estimate.mean.size() == 0) return estimate;
  Gaussian result{estimate.mean.head(own()), {}, {}};
  if (estimate.covariance.size() > 0) result.covariance = estimate.covariance.topLeftCorner(own(), own());
  if (estimate.factor.size() > 0) result.factor = estimate.factor.topRows(own());
  return result;
}

std::vector<Label> NoisyInputs::state_labels() const {
  std::vector<Label> labels = model_->state_labels();
  for (Index i = 0; i < deviations_.size(); ++i)
    labels.push_back({"input_error_" + std::to_string(i + 1), "1"});
  return labels;
}

// The path's first coefficient is the input at the sample (StepInput): the error is held.
const VectorXd& NoisyInputs::true_input(const VectorXd& state, const VectorXd& input) {
  input_ = input;
  if (input.size() > 0) input_.head(deviations_.size()) -= state.tail(deviations_.size());
  inner_state_ = state.head(own());
  return input_;
}

void NoisyInputs::transition(const VectorXd& state, const VectorXd& input, VectorXd& next) {
  const VectorXd& truth = true_input(state, input);
  model_->transition(inner_state_, truth, moved_);
  next.setZero(state.size());
  next.head(own()) = moved_;
}

// Linear in u: a difference of two motions is the derivative by it, with a step of the error's own size.
void NoisyInputs::linearised_transition(const VectorXd& state, const VectorXd& input, VectorXd& next,
                                        MatrixXd& jacobian) {
  const VectorXd& truth = true_input(state, input);
  model_->linearised_transition(inner_state_, truth, moved_, inner_);
  const Index m = deviations_.size();
  next.setZero(state.size());
  next.head(own()) = moved_;
  jacobian.setZero(state.size(), state.size());
  jacobian.topLeftCorner(own(), own()) = inner_;
  VectorXd further;
  for (Index i = 0; i < m && input.size() > 0; ++i) {
    if (deviations_[i] == 0.0) continue;
    moved_input_ = truth;
    moved_input_[i] -= deviations_[i];
    model_->transition(inner_state_, moved_input_, further);
    jacobian.col(own() + i).head(own()) = (further - moved_) / deviations_[i];
  }
}

void NoisyInputs::output(const VectorXd& state, const VectorXd& input, VectorXd& output) {
  const VectorXd& truth = true_input(state, input);
  model_->output(inner_state_, truth, output);
}

void NoisyInputs::output_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) {
  const VectorXd& truth = true_input(state, input);
  model_->output_jacobian(inner_state_, truth, inner_);
  const Index m = deviations_.size();
  jacobian.setZero(inner_.rows(), state.size());
  jacobian.leftCols(own()) = inner_;
  VectorXd here, further;
  if (input.size() > 0) model_->output(inner_state_, truth, here);
  for (Index i = 0; i < m && input.size() > 0; ++i) {
    if (deviations_[i] == 0.0) continue;
    moved_input_ = truth;
    moved_input_[i] -= deviations_[i];
    model_->output(inner_state_, moved_input_, further);
    jacobian.col(own() + i) = (further - here) / deviations_[i];
  }
}

}  // namespace beamid::filters
