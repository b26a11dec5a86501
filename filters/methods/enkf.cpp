// Ensemble Kalman filter [evensen2003]: N members z_i, the estimate their mean and sample covariance. With
// the anomalies A of the members and B of their outputs h(z_i), both over sqrt(N - 1),
//
//     predict      z_i = F(z_i, u) + w_i,   then anomalies times the inflation
//     S = B B^T + R,   G = A B^T S^-1
//     stochastic   z_i += G (y + v_i - h(z_i))                                           [burgers1998]
//     transform    m += G (y - mean h),  A := A (I + B^T R^-1 B)^-1/2, symmetric         [bishop2001],
//     [hunt2007]
//
// Start, w_i and v_i are random draws of exact sample moments, uncorrelated with the members [pham2001],
// [hoteit2015], as long as N >= 2 n + 1 (and n + p + 1): the sampling error of the first two moments is then
// nil, and on linear models both variants are the Kalman filter. With fewer members they are plain draws.
#include <Eigen/SVD>
#include <cmath>
#include <limits>

#include "filters/covariance_factor.hpp"
#include "filters/innovation.hpp"
#include "filters/random.hpp"
#include "filters/whole_number.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class EnsembleKalmanFilter final : public Filter {
 public:
  EnsembleKalmanFilter(std::unique_ptr<DiscreteModel> model, const Options& options)
      : Filter(std::move(model)),
        members_(whole_number(options.number("members"), 2, "enkf", "members", 1000000)),
        seed_(whole_number(options.number("seed"), 0, "enkf", "seed")),
        inflation_(options.number("inflation")),
        transform_(options.text("update") == "transform"),
        random_(static_cast<std::uint64_t>(seed_)) {
    if (!transform_ && options.text("update") != "stochastic")
      throw std::invalid_argument("enkf: update is '" + options.text("update") +
                                  "'; expected stochastic or transform");
    if (!(inflation_ >= 1.0 && std::isfinite(inflation_)))
      throw std::invalid_argument("enkf: inflation is " + std::to_string(inflation_) +
                                  "; expected at least 1");
  }

  void reset(const Gaussian& estimate) override {
    check_estimate(estimate, model_);
    random_ = RandomStream(static_cast<std::uint64_t>(seed_));
    plain_draws_ = false;
    const MatrixXd root = factor_of(estimate);
    estimate_.mean = estimate.mean;
    anomalies_ = root * draw(root.cols(), MatrixXd(0, members_));
    form();
  }

  void predict(const VectorXd& input) override {
    const auto f = [&](const VectorXd& z, VectorXd& value) { model_.transition(z, input, value); };
    spread(f, estimate_.mean, anomalies_);
    const MatrixXd& q = model_.process_noise();
    if (q.size() > 0 && !q.isZero(0.0)) {
      const MatrixXd root = factor_of(q);
      anomalies_ += root * draw(root.cols(), anomalies_);
    }
    anomalies_ *= inflation_;
    form();
  }

  void take_in(const VectorXd& output, const VectorXd& input) override {
    const auto h = [&](const VectorXd& z, VectorXd& value) { model_.output(z, input, value); };
    spread(h, expected_, seen_);
    const MatrixXd& noise = model_.output_noise();
    const double scale = 1.0 / static_cast<double>(members_ - 1);
    correction_.innovation = output - expected_;
    correction_.innovation_covariance.noalias() = scale * seen_ * seen_.transpose();
    correction_.innovation_covariance += noise;
    const MatrixXd gain = weigh(correction_, scale * anomalies_ * seen_.transpose(), factor_);
    estimate_.mean.noalias() += gain * correction_.innovation;
    if (transform_) {
      turn(noise);
    } else {
      const MatrixXd root = factor_of(noise);

      anomalies_.noalias() += gain * (root * draw(root.cols(), anomalies_) - seen_);
    }
    form();
  }

  const Gaussian& estimate() const override { return estimate_; }

  std::vector<std::string> remarks() const override {
    if (!plain_draws_) return {};
    return {std::to_string(members_) + " members are too few for draws of exact moments of " +
            std::to_string(anomalies_.rows()) + " states: the covariance has a sampling error of about " +
            std::to_string(static_cast<int>(100.0 * std::sqrt(2.0 / static_cast<double>(members_)))) +
            " % and at most rank " + std::to_string(members_ - 1)};
  }

 private:
  MatrixXd draw(Index rows, const MatrixXd& others) {
    Draws draws = exact_draws(random_, rows, members_, others);
    plain_draws_ = plain_draws_ || !draws.exact;
    return std::move(draws.values);
  }

  // Mean of f over the members, and the anomalies about it.
  template <class Function>
  void spread(const Function& f, VectorXd& mean, MatrixXd& anomalies) {
    MatrixXd values;
    for (Index i = 0; i < members_; ++i) {
      point_ = estimate_.mean + anomalies_.col(i);
      f(point_, value_);
      if (i == 0) values.resize(value_.size(), members_);
      values.col(i) = value_;
    }
    // About the first member, lest the mean of far-away members lose their small differences.
    const VectorXd first = values.col(0);
    values.colwise() -= first;
    const VectorXd shift = values.rowwise().mean();
    mean = first + shift;
    anomalies = values.colwise() - shift;
  }

  // A (I + B^T R^-1 B)^-1/2 from the singular values of R^-1/2 B = U s V^T: A + (A V)((1 + s^2)^-1/2 - 1)
  // V^T.
  void turn(const MatrixXd& noise) {
    noise_factor_.compute(noise);
    if (noise_factor_.info() != Eigen::Success)
      throw FilterFailure("the output noise is not positive definite; expected so by update = transform",
                          std::numeric_limits<double>::quiet_NaN());
    const MatrixXd whitened = noise_factor_.matrixL().solve(seen_) / std::sqrt(double(members_ - 1));
    const Eigen::JacobiSVD<MatrixXd> svd(whitened.transpose(), Eigen::ComputeThinU);
    const VectorXd shrink = (1.0 + svd.singularValues().array().square()).rsqrt() - 1.0;
    anomalies_ += anomalies_ * svd.matrixU() * shrink.asDiagonal() * svd.matrixU().transpose();
  }

  void form() {
    estimate_.covariance = covariance_of(anomalies_ / std::sqrt(static_cast<double>(members_ - 1)));
    check_finite(estimate_);
  }

  Index members_, seed_;
  double inflation_;
  bool transform_, plain_draws_ = false;
  RandomStream random_;
  Gaussian estimate_;
  VectorXd point_, value_, expected_;
  MatrixXd anomalies_, seen_;  // without 1 / sqrt(N - 1)
  Eigen::LLT<MatrixXd> factor_, noise_factor_;
};

const bool enkf_registered = filter_registry().add(
    {"enkf",
     "ensemble Kalman filter, stochastic or deterministic transform",
     "[evensen2003], [burgers1998], [bishop2001], [hunt2007], [pham2001], [hoteit2015]",
     {{"update", std::string("transform"), "",
       "stochastic: readings perturbed for every member; transform: a square root of the anomalies"},
      {"members", 100.0, "", "how many; 2 n + 1 and n + p + 1 at least for draws of exact moments"},
      {"inflation", 1.0, "", "factor of the anomalies in every prediction"},
      {"seed", 1.0, "", "of the random draws: a whole number"}},
     {contract::exact_on_linear_gaussian, contract::sampled_on_linear_gaussian, contract::identifies},
     [](std::unique_ptr<DiscreteModel> model, const Options& options) {
       return std::make_unique<EnsembleKalmanFilter>(std::move(model), options);
     }});

}  // namespace
}  // namespace beamid::filters
