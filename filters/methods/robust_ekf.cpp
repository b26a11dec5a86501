// Robust extended Kalman filter: as `ekf`, but a reading that the others and the prediction do not expect
// counts less. Output i is weighed by its innovation given those of the others, in deviations of it,
//
//     e_i = (S_w^-1 nu)_i / (S_w^-1)_ii / sqrt(1 / (S_w^-1)_ii - S_ii (1/w_i - 1))
//     w_i = min(1, c / |e_i|)                    huber [huber1964]
//     w_i = min(1, (d + 1) / (d + e_i^2))        student_t, of d degrees [lange1989]
//     S_w = S + diag(S_ii (1/w_i - 1)),          S = H P H^T + R
//
// found by five rounds from w = 1. R grows by the same diagonal, so that the gain of a single output is w_i
// times what it was: however large the reading, it moves the mean by at most c deviations (huber), or by an
// amount that tends to zero (student_t) [durovic1999]. What the correction says (S, likelihood) is meant with
// S_w. Not efficient on Gaussian readings: these are weighed down too where they lie beyond c or 1.
#include <algorithm>
#include <cmath>

#include "filters/innovation.hpp"
#include "filters/linearised_step.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class RobustExtendedKalmanFilter final : public Filter {
 public:
  RobustExtendedKalmanFilter(std::unique_ptr<DiscreteModel> model, const std::string& weight, double degrees,
                             double threshold)
      : Filter(std::move(model)), huber_(weight == "huber"), degrees_(degrees), threshold_(threshold) {
    if (!huber_ && weight != "student_t")
      throw std::invalid_argument("robust_ekf: weight is '" + weight + "'; expected student_t or huber");
    if (!(degrees > 0.0 && std::isfinite(degrees) && threshold > 0.0 && std::isfinite(threshold)))
      throw std::invalid_argument("robust_ekf: degrees is " + std::to_string(degrees) + " and threshold " +
                                  std::to_string(threshold) + "; expected more than 0");
  }

  void reset(const Gaussian& estimate) override {
    estimate_ = as_matrix(estimate, model_);
    readings_ = outlying_ = 0;
  }

  void predict(const VectorXd& input) override {
    model_.linearised_transition(estimate_.mean, input, next_, tangent_);
    estimate_.mean.swap(next_);
    step_.predict(estimate_, tangent_, model_.process_noise());
  }

  void take_in(const VectorXd& output, const VectorXd& input) override {
    model_.output(estimate_.mean, input, expected_);
    model_.output_jacobian(estimate_.mean, input, sensor_);
    correction_.innovation = output - expected_;
    innovation_covariance_.noalias() = sensor_ * estimate_.covariance * sensor_.transpose();
    innovation_covariance_ += model_.output_noise();
    weigh_outputs();
    noise_ = model_.output_noise();
    noise_.diagonal() += excess_;
    step_.correct(estimate_, sensor_, noise_, correction_);
  }

  const Gaussian& estimate() const override { return estimate_; }

  std::vector<std::string> remarks() const override {
    if (outlying_ == 0) return {};
    return {std::to_string(outlying_) + " of " + std::to_string(readings_) +
            " readings were taken for outliers: weighed by less than a tenth"};
  }

 private:
  double weight(double square) const {
    if (huber_) return std::min(1.0, threshold_ / std::sqrt(square));
    return std::min(1.0, (degrees_ + 1.0) / (degrees_ + square));
  }

  // S_ii (1/w_i - 1), what an output's weight adds to its variance (p).
  void weigh_outputs() {
    const VectorXd variance = innovation_covariance_.diagonal();
    excess_.setZero(variance.size());
    const VectorXd& innovation = correction_.innovation;
    VectorXd weights = VectorXd::Ones(variance.size());
    for (int round = 0; round < 5; ++round) {
      MatrixXd weighed = innovation_covariance_;
      weighed.diagonal() += excess_;
      const Eigen::LLT<MatrixXd> factor(weighed);
      if (factor.info() != Eigen::Success) return;  // reported where the innovation is weighed
      const MatrixXd inverse = factor.solve(MatrixXd::Identity(variance.size(), variance.size()));
      const VectorXd solved = factor.solve(innovation);
      for (Index i = 0; i < variance.size(); ++i) {
        const double residual = solved[i] / inverse(i, i);
        // Not below the reading's own noise: the difference cancels where the weight is small.
        const double expected = std::max(1.0 / inverse(i, i) - excess_[i], model_.output_noise()(i, i));
        weights[i] = std::max(weight(residual * residual / expected), 1e-30);
      }
      excess_ = variance.array() * (1.0 / weights.array() - 1.0);
      if (variance.size() == 1) break;  // its residual does not depend on its weight
    }
    readings_ += variance.size();
    outlying_ += (weights.array() < 0.1).count();
  }

  bool huber_;
  double degrees_, threshold_;
  Index readings_ = 0, outlying_ = 0;
  Gaussian estimate_;
  LinearisedStep step_;
  VectorXd next_, expected_, excess_;
  MatrixXd tangent_, sensor_, innovation_covariance_, noise_;
};

const bool robust_ekf_registered = filter_registry().add(
    {"robust_ekf",
     "extended Kalman filter that weighs outlying readings down",
     "[huber1964], [lange1989], [durovic1999]",
     {{"weight", std::string("student_t"), "", "student_t: outliers are ignored; huber: they are limited"},
      {"degrees", 4.0, "", "of freedom of student_t; fewer: heavier tails"},
      {"threshold", 1.345, "", "of huber, in standard deviations; 1.345 costs 5 % on Gaussian readings"}},
     {contract::robust},
     [](std::unique_ptr<DiscreteModel> model, const Options& options) {
       return std::make_unique<RobustExtendedKalmanFilter>(
           std::move(model), options.text("weight"), options.number("degrees"), options.number("threshold"));
     }});

}  // namespace
}  // namespace beamid::filters
