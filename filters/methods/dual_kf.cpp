// Dual Kalman filter for input and state [eftekharazam2015]: one filter for the unknown inputs d, a random
// walk read by the sensors directly, one for the other entries x of the state, given d. With F, H split
// alike,
//
//     predict   z = F(z),   P_x = F_x P_x F_x^T + F_xd P_d F_xd^T + Q_x,   P_d = F_d P_d F_d^T + Q_d
//     inputs    e = y - h(x, d),   d += K_d e,   K_d = P_d H_d^T (H_d P_d H_d^T + S)^-1,   S = H_x P_x H_x^T
//     + R states    e = y - h(x, d),   x += K_x e,   K_x = P_x H_x^T S^-1
//
// As published (`coupled` = false), S = R for the inputs and F_xd P_d F_xd^T is left to a Q_x chosen by hand.
// That the errors of both are correlated counts in neither, so the covariances are not those of the errors;
// and what the sensors do not read of d directly (displacements, velocities) corrects x alone.
#include "filters/innovation.hpp"
#include "filters/latent_inputs.hpp"
#include "filters/linearised_step.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class DualKalmanFilter final : public Filter {
 public:
  DualKalmanFilter(std::unique_ptr<DiscreteModel> model, const std::vector<double>& inputs, bool coupled)
      : Filter(std::move(model)),
        unknown_(find_unknown_inputs("dual_kf", model_, inputs)),
        coupled_(coupled) {
    const auto n = static_cast<Index>(model_.state_labels().size());
    for (Index i = 0; i < n; ++i)
      if (std::find(unknown_.begin(), unknown_.end(), i) == unknown_.end()) rest_.push_back(i);
  }

  void reset(const Gaussian& estimate) override {
    estimate_ = as_matrix(estimate, model_);
    states_ = {{}, estimate_.covariance(rest_, rest_)};
    inputs_ = {{}, estimate_.covariance(unknown_, unknown_)};
    join();
  }

  void predict(const VectorXd& input) override {
    model_.linearised_transition(estimate_.mean, input, next_, tangent_);
    estimate_.mean.swap(next_);
    const MatrixXd& q = model_.process_noise();
    const bool noisy = q.size() > 0;
    states_.mean = estimate_.mean(rest_);
    inputs_.mean = estimate_.mean(unknown_);
    MatrixXd moved = MatrixXd::Zero(states_.mean.size(), states_.mean.size());
    if (coupled_) {
      const MatrixXd through = tangent_(rest_, unknown_);
      moved += through * inputs_.covariance * through.transpose();
    }
    if (noisy) moved += q(rest_, rest_);
    step_.predict(states_, tangent_(rest_, rest_), moved);
    step_.predict(inputs_, tangent_(unknown_, unknown_),
                  noisy ? MatrixXd(q(unknown_, unknown_)) : MatrixXd());
    join();
  }

  void take_in(const VectorXd& output, const VectorXd& input) override {
    model_.output(estimate_.mean, input, expected_);
    model_.output_jacobian(estimate_.mean, input, sensor_);
    const MatrixXd noise = model_.output_noise();
    const MatrixXd direct = sensor_(Eigen::all, unknown_), through = sensor_(Eigen::all, rest_);
    seen_ = seen_ || !direct.isZero(0.0);
    const MatrixXd cross = states_.covariance * through.transpose(), shown = through * cross;
    const MatrixXd whole = direct * inputs_.covariance * direct.transpose() + shown + noise;
    const VectorXd first = output - expected_;
    if (!unknown_.empty()) {
      Correction of_inputs;
      of_inputs.innovation = first;
      inputs_.mean = estimate_.mean(unknown_);
      step_.correct(inputs_, direct, coupled_ ? MatrixXd(shown + noise) : noise, of_inputs);
      estimate_.mean(unknown_) = inputs_.mean;
      model_.output(estimate_.mean, input, expected_);
    }
    states_.mean = estimate_.mean(rest_);
    correction_.innovation = output - expected_;
    step_.correct(states_, through, noise, correction_);
    estimate_.mean(rest_) = states_.mean;
    join();
    if (unknown_.empty()) return;
    correction_.innovation = first;  // what the reading said before either filter took it in
    correction_.innovation_covariance = whole;
    Eigen::LLT<MatrixXd> factor;
    weigh(correction_, cross, factor);
  }

  const Gaussian& estimate() const override { return estimate_; }

  std::vector<std::string> remarks() const override {
    if (unknown_.empty()) return {"no unknown input: this is the extended Kalman filter"};
    std::vector<std::string> all{
        "that errors of inputs and state are correlated counts in neither: standard deviations are too "
        "small"};
    if (!seen_) all.push_back("no sensor reads the unknown inputs directly: they are not estimated at all");
    return all;
  }

 private:
  void join() {
    estimate_.covariance.setZero(estimate_.mean.size(), estimate_.mean.size());
    estimate_.covariance(rest_, rest_) = states_.covariance;
    estimate_.covariance(unknown_, unknown_) = inputs_.covariance;
  }

  std::vector<Index> unknown_, rest_;
  Gaussian estimate_, states_, inputs_;
  bool coupled_, seen_ = false;
  LinearisedStep step_;
  VectorXd next_, expected_;
  MatrixXd tangent_, sensor_;
};

const bool dual_kf_registered = filter_registry().add(
    {"dual_kf",
     "separate Kalman filters for unknown inputs and for the state",
     "[eftekharazam2015]",
     {unknown_inputs_option(),
      {"coupled", true, "", "whether each filter counts the error of the other; false: as published"}},
     {contract::exact_on_linear_gaussian, contract::consistent, contract::identifies,
      contract::unknown_inputs},
     [](std::unique_ptr<DiscreteModel> model, const Options& options) {
       return std::make_unique<DualKalmanFilter>(std::move(model), options.numbers("inputs"),
                                                 options.flag("coupled"));
     }});

}  // namespace
}  // namespace beamid::filters
