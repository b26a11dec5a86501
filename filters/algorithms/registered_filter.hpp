// An algorithm as a filter of the registry, and the model that it sees.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "filters/algorithms/cholesky.hpp"
#include "filters/algorithms/extended_kalman.hpp"
#include "filters/algorithms/square_root_kalman.hpp"
#include "filters/algorithms/unscented_kalman.hpp"
#include "filters/covariance_factor.hpp"
#include "filters/filter.hpp"
#include "filters/innovation.hpp"
#include "filters/observed_model.hpp"

namespace beamid::filters::algorithms {

// A registered filter's model, as the algorithms see models.
//
// To the algorithms a model of N states and P outputs, F and h at the input of the step, is a class with
//
//     linearised_transition(z, next, jacobian)      F(z), dF/dz              (extended_kalman.hpp)
//     output(z, y), output_jacobian(z, jacobian)    h(z), dh/dz
//     transitions(points, moved)                    F of every column        (unscented_kalman.hpp,
//     outputs(points, values)                       h of every column         square_root_kalman.hpp)
//     process_noise(), output_noise()               Q, of size 0 where there is none, and R
//     process_noise_root(), output_noise_root()     any factors of them (square_root_kalman.hpp alone)

class Observed {
 public:
  /// The model, and the input of each step, must outlive this.
  explicit Observed(ObservedModel& model) : model_(model) {}
  void set_input(const Eigen::VectorXd& input) { input_ = &input; }

  void linearised_transition(const Eigen::VectorXd& z, Eigen::VectorXd& next, Eigen::MatrixXd& jacobian) {
    model_.linearised_transition(z, *input_, next, jacobian);
  }
  void output(const Eigen::VectorXd& z, Eigen::VectorXd& y) { model_.output(z, *input_, y); }
  void output_jacobian(const Eigen::VectorXd& z, Eigen::MatrixXd& jacobian) {
    model_.output_jacobian(z, *input_, jacobian);
  }

  // The same for sizes fixed at compile time. Models have dynamic sizes: a few numbers are copied.
  template <int N>
  void linearised_transition(const Vector<double, N>& z, Vector<double, N>& next,
                             Matrix<double, N>& jacobian) {
    point_ = z;
    model_.linearised_transition(point_, *input_, next_, tangent_);
    next = next_;
    jacobian = tangent_;
  }
  template <int N, int P>
  void output(const Vector<double, N>& z, Vector<double, P>& y) {
    point_ = z;
    model_.output(point_, *input_, seen_);
    y = seen_;
  }
  template <int N, int P>
  void output_jacobian(const Vector<double, N>& z, Matrix<double, P, N>& jacobian) {
    point_ = z;
    model_.output_jacobian(point_, *input_, sensor_);
    jacobian = sensor_;
  }

  void transitions(const Eigen::MatrixXd& points, Eigen::MatrixXd& moved) {
    const auto f = [this](const Eigen::VectorXd& z, Eigen::VectorXd& next) {
      model_.transition(z, *input_, next);
    };
    at_each(points, f, next_, moved);
  }
  void outputs(const Eigen::MatrixXd& points, Eigen::MatrixXd& values) {
    const auto h = [this](const Eigen::VectorXd& z, Eigen::VectorXd& y) { output(z, y); };
    at_each(points, h, seen_, values);
  }

  const Eigen::MatrixXd& process_noise() const { return model_.process_noise(); }
  const Eigen::MatrixXd& output_noise() const { return model_.output_noise(); }

  const Eigen::MatrixXd& process_noise_root() {
    if (process_noise_changes_ != model_.process_noise_changes()) {
      const Eigen::MatrixXd& q = model_.process_noise();
      const auto n = static_cast<Eigen::Index>(model_.state_labels().size());
      process_noise_root_ = q.size() > 0 && !q.isZero(0.0) ? factor_of(q) : Eigen::MatrixXd(n, 0);
      process_noise_changes_ = model_.process_noise_changes();
    }
    return process_noise_root_;
  }
  const Eigen::MatrixXd& output_noise_root() {
    if (!same(output_noise_, model_.output_noise())) {
      output_noise_ = model_.output_noise();
      lower_root(output_noise_, output_noise_root_);
    }
    return output_noise_root_;
  }

 private:
  template <class Function>
  void at_each(const Eigen::MatrixXd& points, const Function& f, Eigen::VectorXd& value,
               Eigen::MatrixXd& values) {
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      point_ = points.col(i);
      f(point_, value);
      if (i == 0) values.resize(value.size(), points.cols());
      values.col(i) = value;
    }
  }

  ObservedModel& model_;
  const Eigen::VectorXd* input_ = nullptr;
  Eigen::VectorXd point_, next_, seen_;
  Eigen::MatrixXd tangent_, sensor_;
  Eigen::MatrixXd process_noise_root_, output_noise_, output_noise_root_;
  int process_noise_changes_ = -1;
};

using DynamicUnscentedKalman = UnscentedKalman<double, Eigen::Dynamic, Eigen::Dynamic>;
using DynamicSquareRootKalman = SquareRootKalman<double, Eigen::Dynamic, Eigen::Dynamic>;

/// The same filter of as many outputs as were measured.
template <class Algorithm>
struct OfAnyOutputs {
  using Type = Algorithm;
};
template <int N, int P>
struct OfAnyOutputs<ExtendedKalman<double, N, P>> {
  using Type = ExtendedKalman<double, N, Eigen::Dynamic>;
};
template <class Algorithm>
using AnyOutputs = typename OfAnyOutputs<Algorithm>::Type;

template <class Algorithm>
class RegisteredFilter final : public Filter {
 public:
  template <class... Arguments>
  explicit RegisteredFilter(std::unique_ptr<DiscreteModel> model, const Arguments&... arguments)
      : Filter(std::move(model)), at_step_(model_), algorithm_(arguments...) {}

  void reset(const Gaussian& estimate) override {
    check_estimate(estimate, model_);
    algorithm_.mean = estimate.mean;
    if constexpr (carries_root)
      set_root(estimate);
    else
      algorithm_.covariance = with_covariance(estimate).covariance;
    formed_ = false;
  }

  void predict(const Eigen::VectorXd& input) override {
    at_step_.set_input(input);
    formed_ = false;
    algorithm_.predict(at_step_);
    check();
  }

  void take_in(const Eigen::VectorXd& output, const Eigen::VectorXd& input) override {
    at_step_.set_input(input);
    if constexpr (outputs != Eigen::Dynamic)
      if (output.size() != outputs) {  // some were not measured
        AnyOutputs<Algorithm> some;
        some.mean = algorithm_.mean;
        some.covariance = algorithm_.covariance;
        take_with(some, output);
        algorithm_.mean = some.mean;
        algorithm_.covariance = some.covariance;
        return check();
      }
    take_with(algorithm_, output);
    check();
  }

  const Gaussian& estimate() const override {
    if (formed_) return estimate_;
    estimate_.mean = algorithm_.mean;
    if constexpr (carries_root) {
      estimate_.factor = algorithm_.root;
      estimate_.covariance = covariance_of(algorithm_.root);
    } else {
      estimate_.covariance = algorithm_.covariance;
    }
    formed_ = true;
    return estimate_;
  }

 private:
  static constexpr bool carries_root = std::is_same_v<Algorithm, DynamicSquareRootKalman>;
  static constexpr int outputs = decltype(Algorithm::seen.innovation)::RowsAtCompileTime;

  template <class OneAlgorithm>
  void take_with(OneAlgorithm& algorithm, const Eigen::VectorXd& output) {
    algorithm.look(at_step_, output);
    const auto& seen = algorithm.seen;
    if (!(seen.smallest_pivot > 0.0)) refuse(seen.covariance);
    correction_.innovation = seen.innovation;
    correction_.innovation_covariance = seen.covariance;
    correction_.whitened = seen.whitened;
    correction_.normalised_square = seen.normalised_square;
    const double log_determinant = 2.0 * seen.root.diagonal().array().log().sum();
    const double constant = static_cast<double>(output.size()) * std::log(2.0 * std::numbers::pi);
    correction_.log_likelihood = -0.5 * (seen.normalised_square + log_determinant + constant);
    formed_ = false;
    algorithm.update(at_step_);
  }

  void set_root(const Gaussian& estimate) {
    if (estimate.factor.size() == 0) return lower_root(estimate.covariance, algorithm_.root);
    const Eigen::Index n = estimate.factor.rows(), r = estimate.factor.cols();
    Eigen::MatrixXd array = Eigen::MatrixXd::Zero(std::max(n, r), n);
    array.topRows(r) = estimate.factor.transpose();
    triangularise(array, algorithm_.root);
  }
  /// @throws FilterFailure
  void check() const {
    bool sound = algorithm_.mean.allFinite();
    if constexpr (carries_root) {
      sound = sound && algorithm_.root.allFinite();
    } else {
      const auto variances = algorithm_.covariance.diagonal().array();
      sound = sound && (variances >= 0.0).all() && variances.allFinite();
    }
    if (!sound) [[unlikely]]
      check_finite(estimate());  // which accepts rounding errors below zero
  }

  Observed at_step_;
  Algorithm algorithm_;
  mutable Gaussian estimate_;
  mutable bool formed_ = false;
};

}  // namespace beamid::filters::algorithms
