// Unscented Kalman filter on a factor of the covariance, P = L L^T with L (n x r): sigma points in the
// factor's space [julier2004], scaled [julier2002], in difference form as in ukf.cpp.
//
// Points z_0 = m and m +- sqrt(c) L_i, i = 1..r, c = alpha^2 (r + kappa), each of weight W = 1/(2c); the
// centre's weight is never formed. From the pairs of differences d_i+- = f(z_i+-) - f(z_0) come an odd and an
// even part,
//
//     o_i = (d_i+ - d_i-) / (2 sqrt c),   e_i = (d_i+ + d_i-) / (2 sqrt c),   s = sum e_i / sqrt c
//     P = sum o_i o_i^T + sum e_i e_i^T + (beta - alpha^2) s s^T
//
// so that [o e sqrt(beta - alpha^2) s] is the factor of what follows, cut back by RankLimit: on linear motion
// e = 0 and it keeps its rank. The correction happens in the factor's space alone. With o, e, s of the
// outputs and the gain L G, G = o^T S^-1 (r x p), S = o o^T + e e^T + (beta - alpha^2) s s^T + R,
//
//     L := L T,   T T^T = (I - G o)(I - G o)^T + (G e)(G e)^T + (beta - alpha^2)(G s)(G s)^T + G R G^T
//
// T is found by a QR decomposition: nothing is subtracted from a covariance. Where no rank is cut, L is the
// Cholesky factor, and the points are those of `ukf`.
#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "filters/covariance_factor.hpp"
#include "filters/filter.hpp"
#include "filters/innovation.hpp"
#include "filters/rank_limit.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class LowRankUnscentedKalmanFilter final : public Filter {
 public:
  LowRankUnscentedKalmanFilter(std::unique_ptr<DiscreteModel> model, double alpha, double beta, double kappa,
                               double rank)
      : Filter(std::move(model)), alpha_(alpha), kappa_(kappa), limit_(rank, "low_rank_ukf") {
    const double centre = beta - alpha * alpha;
    if (!(alpha > 0.0 && kappa > -1.0))
      throw std::invalid_argument("low_rank_ukf: alpha and 1 + kappa must be positive; found alpha " +
                                  std::to_string(alpha) + ", 1 + kappa " + std::to_string(1.0 + kappa));
    if (!(alpha * std::sqrt(1.0 + kappa) >= 1e-4))
      throw std::invalid_argument(
          "low_rank_ukf: alpha is too small: sigma points nearer to the mean than 1e-4 standard deviations, "
          "alpha sqrt(1 + kappa), are lost in rounding");
    if (!(centre >= 0.0))
      throw std::invalid_argument("low_rank_ukf: beta is " + std::to_string(beta) +
                                  "; expected at least alpha^2 = " + std::to_string(alpha * alpha) +
                                  ", else covariances may turn negative");
    centre_root_ = std::sqrt(centre);
  }

  void reset(const Gaussian& estimate) override {
    check_estimate(estimate, model_);
    estimate_ = {estimate.mean, {}, factor_of(estimate)};
    with_covariance_ = estimate.covariance.size() > 0;
    limit_.start(estimate_.factor);
    factorise_process_noise();
    formed_ = false;
  }

  void predict(const VectorXd& input) override {
    if (process_noise_changes_ != model_.process_noise_changes()) factorise_process_noise();
    const auto f = [&](const VectorXd& z, VectorXd& value) { model_.transition(z, input, value); };
    propagate(f, centre_);
    estimate_.mean = centre_ + shift_;
    const Index n = estimate_.mean.size(), r = odd_.cols();
    // Even parts below rounding of every variance would only widen the factor.
    const bool curved = (even_.rowwise().squaredNorm().array() >
                         std::numeric_limits<double>::epsilon() * odd_.rowwise().squaredNorm().array())
                            .any();
    MatrixXd& factor = estimate_.factor;
    factor.resize(n, r + (curved ? r + 1 : 0) + process_.cols());
    factor.leftCols(r) = odd_;
    if (curved) factor.middleCols(r, r + 1) << even_, centre_root_ * shift_;
    if (process_.size() > 0) factor.rightCols(process_.cols()) = process_;
    limit_(factor);
    formed_ = false;
    check();
  }

  void take_in(const VectorXd& output, const VectorXd& input) override {
    const auto h = [&](const VectorXd& z, VectorXd& value) { model_.output(z, input, value); };
    propagate(h, centre_);
    const MatrixXd& noise = model_.output_noise();
    const VectorXd spread = centre_root_ * shift_;
    correction_.innovation = output - centre_ - shift_;
    correction_.innovation_covariance = noise;
    correction_.innovation_covariance.noalias() += odd_ * odd_.transpose();
    correction_.innovation_covariance.noalias() += even_ * even_.transpose();
    correction_.innovation_covariance.noalias() += spread * spread.transpose();
    gain_ = weigh(correction_, odd_.transpose(), innovation_factor_);

    step_.noalias() = gain_ * correction_.innovation;
    estimate_.mean.noalias() += estimate_.factor * step_;
    const Index r = odd_.cols(), p = odd_.rows();
    wide_.resize(r, 2 * r + 1 + p);
    wide_ << -gain_ * odd_, gain_ * even_, gain_ * spread, gain_ * factor_of_noise();
    wide_.leftCols(r).diagonal().array() += 1.0;
    const Eigen::HouseholderQR<MatrixXd> qr(wide_.transpose());
    triangle_ = qr.matrixQR().topRows(r).triangularView<Eigen::Upper>();
    estimate_.factor *= triangle_.transpose();
    formed_ = false;
    check();
  }

  const Gaussian& estimate() const override {
    if (with_covariance_ && !formed_) estimate_.covariance = covariance_of(estimate_.factor);
    formed_ = true;
    return estimate_;
  }
  Gaussian marginal(const std::vector<Index>& entries) const override {
    return {estimate_.mean(entries), {}, estimate_.factor(entries, Eigen::all)};
  }
  std::vector<std::string> remarks() const override { return limit_.remarks(); }

 private:
  void factorise_process_noise() {
    const MatrixXd& q = model_.process_noise();
    process_ = q.size() > 0 && !q.isZero(0.0) ? factor_of(q) : MatrixXd();
    process_noise_changes_ = model_.process_noise_changes();
  }

  // f at the mean, and the parts o, e and s of its differences.
  template <class Function>
  void propagate(const Function& f, VectorXd& centre) {
    const Index r = estimate_.factor.cols();
    const double reach = alpha_ * std::sqrt(static_cast<double>(r) + kappa_);  // sqrt c
    f(estimate_.mean, centre);
    odd_.resize(centre.size(), r);
    even_.resize(centre.size(), r);
    for (Index i = 0; i < r; ++i) {
      point_ = estimate_.mean + reach * estimate_.factor.col(i);
      f(point_, ahead_);
      point_ = estimate_.mean - reach * estimate_.factor.col(i);
      f(point_, behind_);
      odd_.col(i) = (ahead_ - behind_) / (2.0 * reach);
      even_.col(i) = ((ahead_ - centre) + (behind_ - centre)) / (2.0 * reach);
    }
    shift_ = even_.rowwise().sum() / reach;
  }

  const MatrixXd& factor_of_noise() {
    if (!same(noise_, model_.output_noise())) {
      noise_ = model_.output_noise();
      noise_root_ = MatrixXd::Zero(noise_.rows(), noise_.rows());
      const MatrixXd root = factor_of(noise_);
      noise_root_.leftCols(root.cols()) = root;
    }
    return noise_root_;
  }

  void check() const {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    if (!estimate_.mean.allFinite()) throw FilterFailure("the mean is not finite", unknown);
    if (!estimate_.factor.allFinite()) throw FilterFailure("the covariance is not finite", unknown);
  }

  double alpha_, kappa_, centre_root_ = 0.0;
  RankLimit limit_;
  mutable Gaussian estimate_;
  mutable bool formed_ = false;
  bool with_covariance_ = false;
  int process_noise_changes_ = 0;
  VectorXd centre_, shift_, point_, ahead_, behind_, step_;
  MatrixXd odd_, even_, process_, gain_, wide_, triangle_, noise_, noise_root_;
  Eigen::LLT<MatrixXd> innovation_factor_;
};

const bool low_rank_ukf_registered = filter_registry().add(
    {"low_rank_ukf",
     "unscented Kalman filter with sigma points along a factor of the covariance: 2r + 1 motions a step",
     "[julier2004], [julier2002], [wan2000]",
     {{"alpha", 1.0, "", "spread of the sigma points"},
      {"beta", 2.0, "", "weight of the second-order mean shift in the covariance; 2 suits a Gaussian"},
      {"kappa", 0.0, "", "secondary spread; 1 + kappa must be positive"},
      {"rank", 0.0, "",
       "largest rank kept where curvature or process noise raise it; 0: the state's size up to 64, else the "
       "rank of the initial estimate"}},
     {contract::exact_on_linear_gaussian, contract::consistent},
     [](std::unique_ptr<DiscreteModel> model, const Options& options) {
       return std::make_unique<LowRankUnscentedKalmanFilter>(std::move(model), options.number("alpha"),
                                                             options.number("beta"), options.number("kappa"),
                                                             options.number("rank"));
     }});

}  // namespace
}  // namespace beamid::filters
