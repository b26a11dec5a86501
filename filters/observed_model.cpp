#include "filters/observed_model.hpp"

#include <numeric>
#include <stdexcept>
#include <string>

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

void require_square_if_any(const std::optional<MatrixXd>& matrix, Index size, const char* name) {
  if (!matrix || (matrix->rows() == size && matrix->cols() == size)) return;
  throw std::invalid_argument(std::string(name) + " is " + std::to_string(matrix->rows()) + " x " +
                              std::to_string(matrix->cols()) + "; expected " + std::to_string(size) + " x " +
                              std::to_string(size));
}

}  // namespace

ObservedModel::ObservedModel(std::unique_ptr<DiscreteModel> model) : model_(std::move(model)) {
  if (!model_) throw std::invalid_argument("there is no model; expected one");
  all_ = static_cast<Index>(model_->output_labels().size());
  observe_all();
}

void ObservedModel::observe(std::vector<Index> outputs) {
  observed_ = std::move(outputs);
  some_noise_ = whole_noise()(observed_, observed_);
}

void ObservedModel::observe_all() {
  if (!partial()) return;
  observed_.resize(static_cast<std::size_t>(all_));
  std::iota(observed_.begin(), observed_.end(), Index{0});
}

void ObservedModel::set_output_noise(std::optional<MatrixXd> noise) {
  require_square_if_any(noise, all_, "output noise");
  output_noise_ = std::move(noise);
  if (partial()) some_noise_ = whole_noise()(observed_, observed_);
}

void ObservedModel::set_process_noise(std::optional<MatrixXd> noise) {
  require_square_if_any(noise, static_cast<Index>(state_labels().size()), "process noise");
  process_noise_ = std::move(noise);
  ++process_noise_changes_;
}

void ObservedModel::set_interval(double dt) {
  if (dt == interval()) return;
  model_->set_interval(dt);
  ++process_noise_changes_;
}

std::vector<Label> ObservedModel::output_labels() const {
  const std::vector<Label> all = model_->output_labels();
  if (!partial()) return all;
  std::vector<Label> some;
  for (const Index i : observed_) some.push_back(all[static_cast<std::size_t>(i)]);
  return some;
}

const MatrixXd& ObservedModel::process_noise() const {
  return process_noise_ ? *process_noise_ : model_->process_noise();
}

void ObservedModel::output(const VectorXd& state, const VectorXd& input, VectorXd& output) {
  if (!partial()) return model_->output(state, input, output);
  model_->output(state, input, whole_output_);
  output = whole_output_(observed_);
}

void ObservedModel::output_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) {
  if (!partial()) return model_->output_jacobian(state, input, jacobian);
  model_->output_jacobian(state, input, whole_jacobian_);
  jacobian = whole_jacobian_(observed_, Eigen::all);
}

}  // namespace beamid::filters
