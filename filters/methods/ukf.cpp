// Unscented Kalman filter [julier2004], scaled [wan2000], in difference form.
//
// Sigma points z_0 = m, z_i = m +- column of sqrt(c P), c = alpha^2 (n + kappa), each of weight W = 1/(2c);
// the centre's weight 1 - n/c is never formed. With d_i = f(z_i) - f(z_0) and s = W sum d_i:
//
//     mean        f(z_0) + s
//     covariance  W sum d_i d_i^T + (beta - alpha^2) s s^T
//
// The weights therefore sum to one exactly, for any alpha, and the covariance is positive for beta >=
// alpha^2: options that break this are refused, and so are points so close that rounding of f is all that
// d_i holds. The correction subtracts nothing either. With e_i = h(z_i) - h(z_0), t = W sum e_i and gain G it
// is, as in Joseph's form,
//
//     P = W sum (d_i - G e_i)(d_i - G e_i)^T + (beta - alpha^2)(s - G t)(s - G t)^T + G R G^T.
#include "filters/covariance_factor.hpp"
#include "filters/filter.hpp"
#include "filters/innovation.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class UnscentedKalmanFilter final : public Filter {
 public:
  UnscentedKalmanFilter(std::unique_ptr<DiscreteModel> model, double alpha, double beta, double kappa)
      : Filter(std::move(model)) {
    const auto n = static_cast<double>(model_.state_labels().size());
    spread_ = alpha * alpha * (n + kappa);
    centre_ = beta - alpha * alpha;
    if (!(alpha > 0.0 && spread_ > 0.0))
      throw std::invalid_argument("ukf: alpha and n + kappa must be positive; found alpha " +
                                  std::to_string(alpha) + ", n + kappa " + std::to_string(n + kappa));
    if (!(std::sqrt(spread_) >= 1e-4))
      throw std::invalid_argument(
          "ukf: alpha is too small: sigma points nearer to the mean than 1e-4 standard deviations, alpha "
          "sqrt(n + kappa), are lost in rounding");
    if (!(centre_ >= 0.0))
      throw std::invalid_argument("ukf: beta is " + std::to_string(beta) + "; expected at least alpha^2 = " +
                                  std::to_string(alpha * alpha) + ", else covariances may turn negative");
  }

  void reset(const Gaussian& belief) override {
    check_belief(belief, model_);
    belief_ = belief;
    if (belief.factor.size() > 0) belief_ = {belief.mean, with_covariance(belief).covariance};
  }

  void predict(const VectorXd& input) override {
    draw_deviations();
    const VectorXd mean = belief_.mean;
    const auto f = [&](const VectorXd& z, VectorXd& value) { model_.transition(z, input, value); };
    propagate(f, mean, belief_.mean, moved_, shift_);
    belief_.mean += shift_;
    belief_.covariance.noalias() = weight() * moved_ * moved_.transpose();
    belief_.covariance.noalias() += centre_ * shift_ * shift_.transpose();
    if (model_.process_noise().size() > 0) belief_.covariance += model_.process_noise();
    check_finite(belief_);
  }

  void take_in(const VectorXd& output, const VectorXd& input) override {
    draw_deviations();
    const auto h = [&](const VectorXd& z, VectorXd& value) { model_.output(z, input, value); };
    propagate(h, belief_.mean, expected_, seen_, output_shift_);
    correction_.innovation = output - expected_ - output_shift_;
    correction_.innovation_covariance.noalias() = weight() * seen_ * seen_.transpose();
    correction_.innovation_covariance.noalias() += centre_ * output_shift_ * output_shift_.transpose();
    correction_.innovation_covariance += model_.output_noise();
    cross_.noalias() = weight() * deviation_ * seen_.transpose();
    gain_ = weigh(correction_, cross_, factor_);

    belief_.mean.noalias() += gain_ * correction_.innovation;
    deviation_.noalias() -= gain_ * seen_;
    shift_.noalias() = gain_ * output_shift_;
    belief_.covariance.noalias() = weight() * deviation_ * deviation_.transpose();
    belief_.covariance.noalias() += centre_ * shift_ * shift_.transpose();
    work_.noalias() = gain_ * model_.output_noise();
    belief_.covariance.noalias() += work_ * gain_.transpose();
    symmetrise(belief_.covariance);
    check_finite(belief_);
  }

  const Gaussian& belief() const override { return belief_; }

 private:
  double weight() const { return 0.5 / spread_; }

  // +- columns of sqrt(c P) about the mean (n x 2n); the state's own s is zero by symmetry.
  void draw_deviations() {
    const Index n = belief_.mean.size();
    root_ = square_root(belief_.covariance, covariance_factor_);
    deviation_.resize(n, 2 * n);
    deviation_ << std::sqrt(spread_) * root_, -std::sqrt(spread_) * root_;
  }

  // f at the centre, d_i = f(z_i) - f(z_0) as columns, and s = W sum d_i.
  template <class Function>
  void propagate(const Function& f, const VectorXd& mean, VectorXd& centre, MatrixXd& differences,
                 VectorXd& shift) {
    f(mean, value_);
    centre = value_;
    differences.resize(centre.size(), deviation_.cols());
    for (Index i = 0; i < deviation_.cols(); ++i) {
      point_ = mean + deviation_.col(i);
      f(point_, value_);
      differences.col(i) = value_ - centre;
    }
    shift = weight() * differences.rowwise().sum();
  }

  double spread_ = 0.0;  // c
  double centre_ = 0.0;  // beta - alpha^2
  Gaussian belief_;
  VectorXd point_, value_, expected_, shift_, output_shift_;
  MatrixXd root_, deviation_, moved_, seen_, cross_, gain_, work_;
  Eigen::LLT<MatrixXd> factor_, covariance_factor_;
};

const bool registered = filter_registry().add(
    {"ukf",
     "unscented Kalman filter, weights exact by construction, Joseph-like update",
     "[julier2004], [wan2000]",
     {{"alpha", 1.0, "", "spread of the sigma points"},
      {"beta", 2.0, "", "weight of the second-order mean shift in the covariance; 2 suits a Gaussian"},
      {"kappa", 0.0, "", "secondary spread; n + kappa must be positive"}},
     {contract::exact_on_linear_gaussian, contract::consistent},
     [](std::unique_ptr<DiscreteModel> model, const Options& options) {
       return std::make_unique<UnscentedKalmanFilter>(std::move(model), options.number("alpha"),
                                                      options.number("beta"), options.number("kappa"));
     }});

}  // namespace
}  // namespace beamid::filters
