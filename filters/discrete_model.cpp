#include "filters/discrete_model.hpp"

#include <stdexcept>
#include <utility>

#include "filters/central_differences.hpp"
#include "filters/observed_model.hpp"

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

void DiscreteModel::set_interval(double dt) {
  if (dt == interval()) return;
  throw std::invalid_argument("the model moves by " + std::to_string(interval()) +
                              " s only; found an interval of " + std::to_string(dt) + " s");
}

void DiscreteModel::linearised_transition(const VectorXd& state, const VectorXd& input, VectorXd& next,
                                          MatrixXd& jacobian) {
  central_differences([&](const VectorXd& z, VectorXd& value) { transition(z, input, value); }, state,
                      state.size(), jacobian);
  transition(state, input, next);
}

void DiscreteModel::move(const VectorXd& state, const VectorXd& input, VectorXd& next, MatrixXd& directions) {
  MatrixXd jacobian;
  linearised_transition(state, input, next, jacobian);
  directions = jacobian * directions;
}

void DiscreteModel::output_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) {
  central_differences([&](const VectorXd& z, VectorXd& value) { output(z, input, value); }, state,
                      static_cast<Index>(output_labels().size()), jacobian);
}

namespace {

void require_positive(double dt) {
  if (!(dt > 0.0))
    throw std::invalid_argument("interval is " + std::to_string(dt) + " s; expected more than 0");
}

class Discretised final : public TimedModel {
 public:
  Discretised(std::shared_ptr<const ContinuousModel> model, double dt, std::unique_ptr<Scheme> scheme,
              Noise noise)
      : TimedModel(dt, std::move(noise)), model_(std::move(model)), scheme_(std::move(scheme)) {}

  std::vector<Label> state_labels() const override { return model_->state_labels(); }
  std::vector<Label> output_labels() const override { return model_->output_labels(); }

  void transition(const VectorXd& state, const VectorXd& input, VectorXd& next) override {
    scheme_->step(*model_, state, input, interval(), next, nullptr);
  }
  void linearised_transition(const VectorXd& state, const VectorXd& input, VectorXd& next,
                             MatrixXd& jacobian) override {
    scheme_->step(*model_, state, input, interval(), next, &jacobian);
  }
  void move(const VectorXd& state, const VectorXd& input, VectorXd& next, MatrixXd& directions) override {
    scheme_->step(*model_, state, input, interval(), next, &tangent_);
    moved_.noalias() = tangent_ * directions;
    directions.swap(moved_);
  }
  void output(const VectorXd& state, const VectorXd& input, VectorXd& output) override {
    model_->output(state, now(input), output);
  }
  void output_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) override {
    model_->output_jacobian(state, now(input), jacobian);
  }

 private:
  std::shared_ptr<const ContinuousModel> model_;
  std::unique_ptr<Scheme> scheme_;
  MatrixXd tangent_, moved_;
  VectorXd now_;

  // The inputs at the sample itself, of a path.
  const VectorXd& now(const VectorXd& path) {
    const Index inputs = model_->input_size();
    if (inputs == 0 || path.size() <= inputs) return path;
    now_ = path.head(inputs);
    return now_;
  }
};

void require_square(const MatrixXd& matrix, Index size, const char* name) {
  if (matrix.rows() == size && matrix.cols() == size) return;
  throw std::invalid_argument(std::string(name) + " is " + std::to_string(matrix.rows()) + " x " +
                              std::to_string(matrix.cols()) + "; expected " + std::to_string(size) + " x " +
                              std::to_string(size));
}

}  // namespace

void rescale(Noise& noise, double from, double dt) {
  require_positive(dt);
  noise.process *= dt / from;
}

std::unique_ptr<DiscreteModel> discretise(std::shared_ptr<const ContinuousModel> model, double dt,
                                          const std::string& scheme, Noise noise) {
  require_positive(dt);
  const auto states = static_cast<Index>(model->state_labels().size());
  if (noise.process.size() > 0) require_square(noise.process, states, "process noise");
  require_square(noise.output, static_cast<Index>(model->output_labels().size()), "output noise");
  scheme_registry().find(scheme);
  if (auto structured = model->structured(dt, scheme, noise)) return structured;
  if (noise.process.size() == 0) noise.process.setZero(states, states);
  return std::make_unique<Discretised>(std::move(model), dt, scheme_registry().make(scheme, {}),
                                       std::move(noise));
}

}  // namespace beamid::filters
