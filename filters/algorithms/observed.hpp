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
#pragma once

#include "filters/algorithms/cholesky.hpp"
#include "filters/covariance_factor.hpp"
#include "filters/observed_model.hpp"

namespace beamid::filters::algorithms {

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
  Eigen::MatrixXd process_noise_root_, output_noise_, output_noise_root_;
  int process_noise_changes_ = -1;
};

}  // namespace beamid::filters::algorithms
