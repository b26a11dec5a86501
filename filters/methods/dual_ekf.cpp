// Dual extended Kalman filter [wan2001]: one filter for the states x, given the parameters t, and one for the
// parameters, which sees them through the states' innovations. With F = [F_x F_t], H = [H_x H_t] and the
// sensitivity W = dx/dt of the state filter's mean,
//
//     predict    x = F(x, t),  P_x = F_x P_x F_x^T + Q_x,   W = F_x W + F_t,   P_t = P_t + Q_t
//     S_x = H_x P_x H_x^T + R,   C = H_x W + H_t,   nu = y - h(x, t)
//     states     x += G_x nu,  G_x = P_x H_x^T S_x^-1,      W := (I - G_x H_x) W - G_x H_t
//     parameters t += G_t nu,  G_t = P_t C^T (C P_t C^T + S_x)^-1
//
// both covariances by Joseph's form. `coupled` (default): when t moves by d, x moves along by W d, and the
// covariance of both together is [P_x + W P_t W^T, W P_t; P_t W^T, P_t]: two filters that are together the
// joint one, as in separate-bias estimation [friedland1969]. Without it the states stay where they are and
// the two covariances are all that is said: the filter as published, which needs process noise on the states
// to forget what they learnt under earlier parameters.
#include <algorithm>

#include "filters/innovation.hpp"
#include "filters/latent_inputs.hpp"
#include "filters/linearised_step.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class DualExtendedKalmanFilter final : public Filter {
 public:
  DualExtendedKalmanFilter(std::unique_ptr<DiscreteModel> model, const std::vector<double>& parameters,
                           bool coupled)
      : Filter(std::move(model)),
        coupled_(coupled),
        stated_(state_entries("dual_ekf: parameters", parameters, model_.state_labels().size())) {}

  void reset(const Gaussian& estimate) override {
    estimate_ = as_matrix(estimate, model_);
    parameter_ = stated_;
    split_ = !stated_.empty();
    if (split_) split();
  }

  void predict(const VectorXd& input) override {
    model_.linearised_transition(estimate_.mean, input, next_, tangent_);
    if (!split_) find_parameters();
    estimate_.mean.swap(next_);
    sensitivity_ = tangent_(state_, state_) * sensitivity_ + tangent_(state_, parameter_);
    const MatrixXd& q = model_.process_noise();
    const bool noisy = q.size() > 0;
    states_.mean = estimate_.mean(state_);
    parameters_.mean = estimate_.mean(parameter_);
    step_.predict(states_, tangent_(state_, state_), noisy ? MatrixXd(q(state_, state_)) : MatrixXd());
    if (!noisy || (q(parameter_, Eigen::all).isZero(0.0))) return join();
    if (!coupled_) {
      parameters_.covariance += q(parameter_, parameter_);
      return join();
    }
    join();  // parameters that wander: W is another one
    estimate_.covariance(parameter_, parameter_) += q(parameter_, parameter_);
    estimate_.covariance(parameter_, state_) += q(parameter_, state_);
    estimate_.covariance(state_, parameter_) += q(state_, parameter_);
    split();
  }

  void take_in(const VectorXd& output, const VectorXd& input) override {
    model_.output(estimate_.mean, input, expected_);
    model_.output_jacobian(estimate_.mean, input, sensor_);
    correction_.innovation = output - expected_;
    if (!split_) {  // nothing has moved yet: which are the parameters is not known
      step_.correct(estimate_, sensor_, model_.output_noise(), correction_);
      return;
    }
    const MatrixXd state_sensor = sensor_(Eigen::all, state_), other = sensor_(Eigen::all, parameter_);
    const MatrixXd through = state_sensor * sensitivity_ + other;
    Correction given_parameters;
    given_parameters.innovation = correction_.innovation;
    step_.correct(states_, state_sensor, model_.output_noise(), given_parameters);
    sensitivity_.noalias() -= step_.gain() * through;
    step_.correct(parameters_, through, given_parameters.innovation_covariance, correction_);
    if (coupled_) states_.mean.noalias() += sensitivity_ * (step_.gain() * correction_.innovation);
    join();
    check_finite(estimate_);
  }

  const Gaussian& estimate() const override { return estimate_; }

  std::vector<std::string> remarks() const override {
    std::string names;
    const std::vector<Label> labels = model_.state_labels();
    for (const Index i : parameter_)
      names += (names.empty() ? "" : ", ") + labels[static_cast<std::size_t>(i)].name;
    return {"parameters apart from the states: " + (names.empty() ? "none" : names)};
  }

 private:
  // Entries that the transition leaves as they are, whatever the others.
  void find_parameters() {
    const Index n = estimate_.mean.size();
    for (Index i = 0; i < n; ++i) {
      VectorXd row = tangent_.row(i);
      row[i] -= 1.0;
      // The differences of a constant divide its rounding by their step.
      const bool constant = row.cwiseAbs().maxCoeff() <= 1e-9;
      if (constant && next_[i] == estimate_.mean[i]) parameter_.push_back(i);
    }
    split_ = true;
    split();
  }

  void split() {
    const Index n = estimate_.mean.size();
    state_.clear();
    for (Index i = 0; i < n; ++i)
      if (std::find(parameter_.begin(), parameter_.end(), i) == parameter_.end()) state_.push_back(i);
    parameters_ = {estimate_.mean(parameter_), estimate_.covariance(parameter_, parameter_)};
    states_ = {estimate_.mean(state_), estimate_.covariance(state_, state_)};
    sensitivity_.setZero(states_.mean.size(), parameters_.mean.size());
    if (!coupled_) return;
    // W = P_xt P_t^-1; where a parameter is known exactly it is not correlated with anything.
    const MatrixXd cross = estimate_.covariance(state_, parameter_);
    if (parameter_.empty() || cross.isZero(0.0)) return;
    const Eigen::LDLT<MatrixXd> factor(parameters_.covariance);
    sensitivity_ = factor.solve(cross.transpose()).transpose();
    states_.covariance -= sensitivity_ * cross.transpose();
    symmetrise(states_.covariance);
  }

  void join() {
    estimate_.mean(state_) = states_.mean;
    estimate_.mean(parameter_) = parameters_.mean;
    estimate_.covariance(parameter_, parameter_) = parameters_.covariance;
    MatrixXd cross = MatrixXd::Zero(states_.mean.size(), parameters_.mean.size()), all = states_.covariance;
    if (coupled_) {
      cross = sensitivity_ * parameters_.covariance;
      all.noalias() += cross * sensitivity_.transpose();
      symmetrise(all);
    }
    estimate_.covariance(state_, state_) = all;
    estimate_.covariance(state_, parameter_) = cross;
    estimate_.covariance(parameter_, state_) = cross.transpose();
  }

  bool coupled_, split_ = false;
  std::vector<Index> stated_, state_, parameter_;
  Gaussian estimate_, states_, parameters_;
  LinearisedStep step_;
  VectorXd next_, expected_;
  MatrixXd tangent_, sensor_, sensitivity_;
};

const bool dual_ekf_registered = filter_registry().add(
    {"dual_ekf",
     "separate extended Kalman filters for states and parameters",
     "[wan2001], [friedland1969]",
     {{"parameters", std::vector<double>{}, "",
       "entries of the state that are parameters, counted from 0; empty: those the transition keeps "
       "constant"},
      {"coupled", true, "", "whether the states move along with the parameters; false: as published"}},
     {contract::exact_on_linear_gaussian, contract::consistent, contract::identifies},
     [](std::unique_ptr<DiscreteModel> model, const Options& options) {
       return std::make_unique<DualExtendedKalmanFilter>(std::move(model), options.numbers("parameters"),
                                                         options.flag("coupled"));
     }});

}  // namespace
}  // namespace beamid::filters
