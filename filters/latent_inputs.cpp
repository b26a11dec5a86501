#include "filters/latent_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <unsupported/Eigen/MatrixFunctions>

namespace beamid::filters {

std::vector<Eigen::Index> state_entries(const std::string& what, const std::vector<double>& stated,
                                        std::size_t size) {
  std::vector<Eigen::Index> entries;
  for (const double entry : stated) {
    const auto index = static_cast<Eigen::Index>(entry);
    if (!(entry >= 0.0 && entry < static_cast<double>(size)) || static_cast<double>(index) != entry ||
        std::find(entries.begin(), entries.end(), index) != entries.end())
      throw std::invalid_argument(what + " hold " + std::to_string(entry) +
                                  "; expected different whole numbers from 0 to " + std::to_string(size - 1));
    entries.push_back(index);
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

OptionSpec unknown_inputs_option() {
  return {"inputs", std::vector<double>{}, "",
          "entries of the state that are unknown inputs, counted from 0; empty: those called "
          "unknown_input_1, ..."};
}

std::vector<Eigen::Index> find_unknown_inputs(const std::string& filter, const DiscreteModel& model,
                                              const std::vector<double>& stated) {
  const std::vector<Label> labels = model.state_labels();
  if (!stated.empty()) return state_entries(filter + ": inputs", stated, labels.size());
  const std::string begins = "unknown_input_", rate = "_rate";
  std::vector<Eigen::Index> found;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const std::string& name = labels[i].name;
    if (!name.starts_with(begins)) continue;
    if (name.ends_with(rate))
      throw std::invalid_argument(
          filter + ": " + name.substr(0, name.size() - rate.size()) +
          " has a rate of its own, by which it is known beforehand; expected the process "
          "random_walk or ornstein_uhlenbeck");
    found.push_back(static_cast<Eigen::Index>(i));
  }
  return found;
}

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

namespace {

using Process = LatentInput::Process;

// l, or 1 / tau, by which a process forgets itself [1/s].
double rate_of(const LatentInput& one) {
  if (one.process == Process::random_walk) return 0.0;
  return (one.process == Process::matern ? std::sqrt(3.0) : 1.0) / one.correlation_time;
}

// Of the white noise that drives p, or its rate.
double intensity_of(const LatentInput& one) {
  const double variance = one.deviation * one.deviation;
  if (one.process == Process::random_walk) return variance / one.correlation_time;
  return (one.process == Process::matern ? 4.0 : 2.0) * rate_of(one) * variance;
}

double start_variance(const LatentInput& one) {
  constexpr double anywhere = 100.0;  // deviations
  return std::pow(one.deviation * (one.process == Process::random_walk ? anywhere : 1.0), 2);
}

void check_latent(const LatentInput& one, Index inputs) {
  if (one.input < 0 || one.input >= inputs)
    throw std::invalid_argument("input " + std::to_string(one.input + 1) + " of " + std::to_string(inputs) +
                                " is not measured");
  for (const double number : {one.deviation, one.correlation_time})
    if (!(number > 0.0 && std::isfinite(number)))
      throw std::invalid_argument("an unknown input of standard deviation or correlation time " +
                                  std::to_string(number) + "; expected a positive number");
}

}  // namespace

LatentInputs::LatentInputs(std::shared_ptr<const LinearMotion> motion, std::vector<LatentInput> latent)
    : motion_(std::move(motion)), latent_(std::move(latent)), own_(motion_->motion_size()) {
  for (const LatentInput& one : latent_) {
    check_latent(one, motion_->input_size());
    for (const LatentInput& other : latent_)
      if (&other != &one && other.input == one.input)
        throw std::invalid_argument("input " + std::to_string(one.input + 1) + " is unknown twice");
    places_.push_back(own_ + added_);
    added_ += one.states();
  }
}

Gaussian LatentInputs::with_latent(const Gaussian& estimate) const {
  const Index rest = parameter_size();
  const MatrixXd inner = estimate.covariance.size() > 0
                             ? estimate.covariance
                             : MatrixXd(estimate.factor * estimate.factor.transpose());
  Gaussian result{VectorXd::Zero(own_ + added_ + rest), {}, {}};
  result.covariance.setZero(result.mean.size(), result.mean.size());
  result.mean.head(own_) = estimate.mean.head(own_);
  result.mean.tail(rest) = estimate.mean.tail(rest);
  result.covariance.topLeftCorner(own_, own_) = inner.topLeftCorner(own_, own_);
  result.covariance.topRightCorner(own_, rest) = inner.topRightCorner(own_, rest);
  result.covariance.bottomLeftCorner(rest, own_) = inner.bottomLeftCorner(rest, own_);
  result.covariance.bottomRightCorner(rest, rest) = inner.bottomRightCorner(rest, rest);
  for (std::size_t i = 0; i < latent_.size(); ++i)
    result.covariance.diagonal().segment(places_[i], latent_[i].states()).array() =
        start_variance(latent_[i]);
  return result;
}

// exp([-A, S; 0, A^T] dt) = [., F^-1 Q; 0, F^T] with the intensity S of the noise.
MatrixXd LatentInputs::process_noise(const VectorXd& state, double interval) const {
  const Index n = motion_size(), all = n + parameter_size();
  MatrixXd a;
  motion_matrix(state, a);
  MatrixXd block = MatrixXd::Zero(2 * n, 2 * n);
  block.topLeftCorner(n, n) = -a;
  block.bottomRightCorner(n, n) = a.transpose();
  for (std::size_t i = 0; i < latent_.size(); ++i) {
    const Index driven = places_[i] + latent_[i].states() - 1;
    block(driven, n + driven) = intensity_of(latent_[i]);
  }
  const MatrixXd moved = (block * interval).exp();
  const MatrixXd q = moved.bottomRightCorner(n, n).transpose() * moved.topRightCorner(n, n);
  MatrixXd noise = MatrixXd::Zero(all, all);
  noise.topLeftCorner(n, n) = 0.5 * (q + q.transpose());
  return noise;
}

std::vector<Label> LatentInputs::state_labels() const {
  const std::vector<Label> own = motion_->state_labels();
  std::vector<Label> labels(own.begin(), own.begin() + own_);
  for (std::size_t i = 0; i < latent_.size(); ++i) {
    const std::string name = "unknown_input_" + std::to_string(i + 1);
    labels.push_back({name, "1"});
    if (latent_[i].states() == 2) labels.push_back({name + "_rate", "1"});
  }
  labels.insert(labels.end(), own.begin() + own_, own.end());
  return labels;
}

VectorXd LatentInputs::own_state(const VectorXd& state) const {
  VectorXd own(state.size() - added_);
  own << state.head(own_), state.tail(state.size() - own_ - added_);
  return own;
}

// The path's first coefficient is the input at the sample; without measured inputs there is no path.
VectorXd LatentInputs::whole_input(const VectorXd& state, const VectorXd& input) const {
  VectorXd whole = input.size() > 0 ? input : VectorXd::Zero(input_size());
  for (std::size_t i = 0; i < latent_.size(); ++i) whole[latent_[i].input] += state[places_[i]];
  return whole;
}

// What the processes do to the motion, through B (l x m).
void LatentInputs::couple(const MatrixXd& through, MatrixXd& matrix) const {
  for (std::size_t i = 0; i < latent_.size(); ++i)
    matrix.col(places_[i]).head(own_) = through.col(latent_[i].input);
}

void LatentInputs::motion_matrix(const VectorXd& state, MatrixXd& matrix) const {
  const VectorXd own = own_state(state);
  MatrixXd inner, through;
  motion_->motion_matrix(own, inner);
  motion_->input_matrix(own, through);
  matrix.setZero(motion_size(), motion_size());
  matrix.topLeftCorner(own_, own_) = inner;
  couple(through, matrix);
  for (std::size_t i = 0; i < latent_.size(); ++i) {
    const double rate = rate_of(latent_[i]);
    const Index at = places_[i];
    if (latent_[i].states() == 1)
      matrix(at, at) = -rate;
    else
      matrix.block<2, 2>(at, at) << 0.0, rate, -rate, -2.0 * rate;
  }
}

void LatentInputs::motion_matrix_derivative(const VectorXd& state, Index j, MatrixXd& matrix) const {
  const VectorXd own = own_state(state);
  MatrixXd inner, through;
  motion_->motion_matrix_derivative(own, j, inner);
  motion_->input_matrix_derivative(own, j, through);
  matrix.setZero(motion_size(), motion_size());
  matrix.topLeftCorner(own_, own_) = inner;
  couple(through, matrix);
}

void LatentInputs::input_matrix(const VectorXd& state, MatrixXd& matrix) const {
  MatrixXd inner;
  motion_->input_matrix(own_state(state), inner);
  matrix.setZero(motion_size(), inner.cols());
  matrix.topRows(own_) = inner;
}

void LatentInputs::input_matrix_derivative(const VectorXd& state, Index j, MatrixXd& matrix) const {
  MatrixXd inner;
  motion_->input_matrix_derivative(own_state(state), j, inner);
  matrix.setZero(motion_size(), inner.cols());
  matrix.topRows(own_) = inner;
}

void LatentInputs::output(const VectorXd& state, const VectorXd& input, VectorXd& output) const {
  motion_->output(own_state(state), whole_input(state, input), output);
}

// Linear in the inputs: a unit's difference is the derivative by one.
void LatentInputs::output_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) const {
  const VectorXd own = own_state(state), whole = whole_input(state, input);
  MatrixXd inner;
  motion_->output_jacobian(own, whole, inner);
  jacobian.setZero(inner.rows(), state.size());
  jacobian.leftCols(own_) = inner.leftCols(own_);
  jacobian.rightCols(parameter_size()) = inner.rightCols(parameter_size());
  VectorXd here, there;
  motion_->output(own, whole, here);
  for (std::size_t i = 0; i < latent_.size(); ++i) {
    VectorXd further = whole;
    further[latent_[i].input] += latent_[i].deviation;
    motion_->output(own, further, there);
    jacobian.col(places_[i]) = (there - here) / latent_[i].deviation;
  }
}

}  // namespace beamid::filters
