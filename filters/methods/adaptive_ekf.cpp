// Adaptive extended Kalman filter: noise as large as the innovations say [mehra1970], [mohamed1999]. Beside
// the steps of `ekf`, with nu = y - h(m-) before and e = y - h(m+) after each correction,
//
//     R := R + a (e e^T + H P+ H^T - R)           whose expectation is R
//     Q := Q + a (G nu nu^T G^T - Q)              covariance matching, where asked for
//
// a = 1 / window, but 1 / (window / 5 + k) in the first k corrections: the model's own noise is the first
// guess, and counts as much as window / 5 readings. Both are sums of squares, hence positive. Where only some
// outputs were measured, their block of R is replaced, and the correlations with the others are kept:
// R := T R T^T, T = diag(L' L^-1, I), from the old block L L^T to the new one L' L'^T.
#include <cmath>
#include <limits>

#include "filters/covariance_factor.hpp"
#include "filters/innovation.hpp"
#include "filters/linearised_step.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class AdaptiveExtendedKalmanFilter final : public Filter {
 public:
  AdaptiveExtendedKalmanFilter(std::unique_ptr<DiscreteModel> model, double window, const std::string& adapt)
      : Filter(std::move(model)), window_(window), adapt_r_(adapt != "process"), adapt_q_(adapt != "output") {
    if (!(window >= 2.0 && std::isfinite(window)))
      throw std::invalid_argument("adaptive_ekf: window is " + std::to_string(window) +
                                  "; expected at least 2 readings");
    if (adapt != "output" && adapt != "process" && adapt != "both")
      throw std::invalid_argument("adaptive_ekf: adapt is '" + adapt + "'; expected output, process or both");
  }

  void reset(const Gaussian& estimate) override {
    estimate_ = as_matrix(estimate, model_);
    model_.observe_all();
    reported_ = noise_ = model_.output_noise();
    take_process_noise();
    readings_ = 0.0;
  }

  void predict(const VectorXd& input) override {
    if (process_noise_changes_ != model_.process_noise_changes()) take_process_noise();
    model_.linearised_transition(estimate_.mean, input, next_, tangent_);
    estimate_.mean.swap(next_);
    step_.predict(estimate_, tangent_, process_);
  }

  void take_in(const VectorXd& output, const VectorXd& input) override {
    const std::vector<Index>& seen = model_.observed();
    if (!same(model_.output_noise(), reported_(seen, seen))) {  // told anew from outside: the new first guess
      replace_block(noise_, seen, model_.output_noise());
      reported_(seen, seen) = model_.output_noise();
    }
    model_.output(estimate_.mean, input, expected_);
    model_.output_jacobian(estimate_.mean, input, sensor_);
    correction_.innovation = output - expected_;
    const MatrixXd noise = noise_(seen, seen);
    step_.correct(estimate_, sensor_, noise, correction_);

    readings_ += 1.0;
    const double share = 1.0 / std::min(window_, 0.2 * window_ + readings_);
    if (adapt_r_) {
      model_.output(estimate_.mean, input, expected_);
      const VectorXd residual = output - expected_;
      const MatrixXd said =
          residual * residual.transpose() + sensor_ * estimate_.covariance * sensor_.transpose();
      MatrixXd block = (1.0 - share) * noise + share * said;
      // Readings without noise: R must not vanish, lest S become singular.
      block.diagonal() = block.diagonal().cwiseMax(smallest_share_ * reported_.diagonal()(seen));
      symmetrise(block);
      replace_block(noise_, seen, block);
    }
    if (adapt_q_) {
      const VectorXd moved = step_.gain() * correction_.innovation;
      process_ = (1.0 - share) * process_ + share * moved * moved.transpose();
    }
  }

  const Gaussian& estimate() const override { return estimate_; }

  std::vector<std::string> remarks() const override {
    std::vector<std::string> result;
    const auto deviations = [](const MatrixXd& noise, const std::vector<Label>& labels) {
      std::string text;
      for (Index i = 0; i < noise.rows(); ++i) {
        char number[32];
        std::snprintf(number, sizeof number, "%.4g", std::sqrt(noise(i, i)));
        const Label& label = labels[static_cast<std::size_t>(i)];
        text += (i > 0 ? ", " : "") + label.name + " " + number + " " + label.unit;
      }
      return text;
    };
    const auto all = static_cast<std::size_t>(noise_.rows());
    if (adapt_r_ && model_.output_labels().size() == all)
      result.push_back("estimated standard deviations of the output noise: " +
                       deviations(noise_, model_.output_labels()));
    if (adapt_q_)
      result.push_back("estimated standard deviations of the process noise: " +
                       deviations(process_, model_.state_labels()));
    return result;
  }

 private:
  static constexpr double smallest_share_ = 1e-12;

  void take_process_noise() {
    const auto n = static_cast<Index>(model_.state_labels().size());
    process_ = model_.process_noise();
    if (process_.size() == 0) process_.setZero(n, n);
    process_noise_changes_ = model_.process_noise_changes();
  }

  static void replace_block(MatrixXd& noise, const std::vector<Index>& seen, const MatrixXd& block) {
    if (static_cast<Index>(seen.size()) == noise.rows()) {
      noise = block;
      return;
    }
    const Eigen::LLT<MatrixXd> before(MatrixXd(noise(seen, seen))), after(block);
    if (before.info() != Eigen::Success || after.info() != Eigen::Success)
      throw FilterFailure("the estimated output noise is not positive definite",
                          std::numeric_limits<double>::quiet_NaN());
    const MatrixXd rows = noise(seen, Eigen::all);
    MatrixXd turned = after.matrixL() * MatrixXd(before.matrixL().solve(rows));
    noise(seen, Eigen::all) = turned;
    noise(Eigen::all, seen) = turned.transpose();
    noise(seen, seen) = block;
  }

  double window_, readings_ = 0.0;
  bool adapt_r_, adapt_q_;
  int process_noise_changes_ = 0;
  Gaussian estimate_;
  LinearisedStep step_;
  VectorXd next_, expected_;
  MatrixXd reported_, noise_, process_, tangent_,
      sensor_;  // noise_: R (p x p) as estimated, reported_: as given
};

const bool adaptive_ekf_registered = filter_registry().add(
    {"adaptive_ekf",
     "extended Kalman filter that estimates its noise from the innovations",
     "[mehra1970], [mohamed1999]",
     {{"window", 100.0, "", "readings over which the noise is averaged, exponentially"},
      {"adapt", std::string("output"), "",
       "output: R; process: Q, which lets constants drift; both: not separable in short records"}},
     {contract::identifies},
     [](std::unique_ptr<DiscreteModel> model, const Options& options) {
       return std::make_unique<AdaptiveExtendedKalmanFilter>(std::move(model), options.number("window"),
                                                             options.text("adapt"));
     }});

}  // namespace
}  // namespace beamid::filters
