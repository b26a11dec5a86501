#include "filters/latent_inputs.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <unsupported/Eigen/MatrixFunctions>

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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
      throw std::invalid_argument("an unknown input of deviation or correlation time " +
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
