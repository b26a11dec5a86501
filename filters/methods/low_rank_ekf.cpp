// Extended Kalman filter on a factor of the covariance, P = (S T)(S T)^T: S (n x r) directions in the state,
// T (r x r) upper triangular.
//
// Without process noise the covariance keeps the rank r of what is uncertain at first. The model moves the
// directions, S := J S, and the measurements turn to T alone, so that a step costs O(n r) and no n x n matrix
// is formed. With the noise R = L diag(d) L^T, Y = H S and Z = Y T,
//
//     innovation covariance   Z Z^T + R
//     mean                    m += S (T Z^T (Z Z^T + R)^-1 (y - h(m)))
//     factor                  T := T M, output after output of L^-1 y     [carlson1973], low_rank_ekf.cpp
//
// S T itself is formed only when the estimate is asked for, or when the directions have become so much alike
// that what T makes of them cancels (docs/theory/low_rank.md).
//
// Process noise Q adds a square root of Q as further columns; RankLimit cuts them back.
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "filters/covariance_factor.hpp"
#include "filters/filter.hpp"
#include "filters/innovation.hpp"
#include "filters/rank_limit.hpp"

namespace beamid::filters {
namespace {

// The square root of a covariance as measurements turn it.

/// T (r x r) upper triangular, T T^T the covariance of r coefficients, the identity at first.
///
/// An output of noise d that sees them as z^T = y^T T turns it into T M, M upper triangular [carlson1973]:
///
///     M M^T = I - z z^T / (d + z^T z),   b_j = d + z_1^2 + ... + z_j^2
///     M_jj = sqrt(b_j-1 / b_j),   M_ij = -z_i z_j / sqrt(b_j-1 b_j)
///
/// The diagonal is a product of ratios below one: the covariance cannot lose its positivity.
class TriangularRoot {
 public:
  void restart(Eigen::Index size);  ///< T = I
  const Eigen::MatrixXd& matrix() const { return root_; }

  /// @param seen how outputs of independent noises see the coefficients, a row y^T each (p x r).
  /// @param variances d of each (p); zero: without noise.
  void take_in(const Eigen::MatrixXd& seen, const Eigen::VectorXd& variances);

  /// Asked after every `interval` calls of take_in(): whether what the outputs saw of a column of T was a
  /// small difference of larger numbers, or T is about to leave the range of numbers. Over an interval, since
  /// an output may pass through zero.
  bool cancels();
  static constexpr Eigen::Index interval = 64;

 private:
  void take_in(const Eigen::MatrixXd& seen, Eigen::Index output, double variance);

  Eigen::MatrixXd root_;
  Eigen::VectorXd partial_, terms_, sums_;  // sum z_j T_j; squares of sum |y_i T_ij| and of z_j (r)
};

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

void TriangularRoot::restart(Index size) {
  root_.setIdentity(size, size);
  terms_.setZero(size);
  sums_.setZero(size);
}

void TriangularRoot::take_in(const MatrixXd& seen, const VectorXd& variances) {
  for (Index i = 0; i < seen.rows(); ++i) take_in(seen, i, variances[i]);
}

void TriangularRoot::take_in(const MatrixXd& seen, Index output, double variance) {
  const Index r = root_.cols();
  const double weight = variance > 0.0 ? 1.0 / variance : 1.0;
  partial_.setZero(r);
  double below = variance;
  for (Index j = 0; j < r; ++j) {
    double* column = &root_(0, j);
    double z = 0.0, without_signs = 0.0;
    for (Index i = 0; i <= j; ++i) {
      const double term = seen(output, i) * column[i];
      z += term;
      without_signs += std::abs(term);
    }
    terms_[j] += weight * without_signs * without_signs;
    sums_[j] += weight * z * z;
    const double above = below + z * z;
    if (z == 0.0 || !(above > 0.0)) continue;
    const double kept = std::sqrt(below / above), share = below > 0.0 ? z / std::sqrt(below * above) : 0.0;
    for (Index i = 0; i <= j; ++i) {
      const double before = column[i];
      column[i] = kept * before - share * partial_[i];
      partial_[i] += z * before;
    }
    below = above;
  }
}

bool TriangularRoot::cancels() {
  constexpr double digits_lost = 1e4, smallest = 1e-100;
  const bool cancelling = (terms_.array() > digits_lost * digits_lost * sums_.array()).any();
  terms_.setZero();
  sums_.setZero();
  return cancelling || root_.diagonal().minCoeff() < smallest;
}

class LowRankExtendedKalmanFilter final : public Filter {
 public:
  LowRankExtendedKalmanFilter(std::unique_ptr<DiscreteModel> model, double rank)
      : Filter(std::move(model)), limit_(rank, "low_rank_ekf") {}

  void reset(const Gaussian& estimate) override {
    check_estimate(estimate, model_);
    with_covariance_ = estimate.covariance.size() > 0;
    estimate_ = {estimate.mean, {}};
    corrections_ = 0;
    directions_ = factor_of(estimate);
    limit_.start(directions_);
    restart();
    factorise_process_noise();
  }

  void predict(const VectorXd& input) override {
    if (process_noise_changes_ != model_.process_noise_changes()) factorise_process_noise();
    model_.move(estimate_.mean, input, next_, directions_);
    estimate_.mean.swap(next_);
    formed_ = false;
    if (process_.size() > 0) {
      MatrixXd wide(directions_.rows(), directions_.cols() + process_.cols());
      wide << formed_factor(), process_;
      limit_(wide);
      directions_.swap(wide);
      restart();
    }
    check();
  }

  void take_in(const VectorXd& output, const VectorXd& input) override {
    model_.output(estimate_.mean, input, expected_);
    model_.output_jacobian(estimate_.mean, input, sensor_);
    correction_.innovation = output - expected_;
    seen_.noalias() = sensor_ * directions_;
    weighed_.noalias() = seen_ * triangle();
    correction_.innovation_covariance = model_.output_noise();
    correction_.innovation_covariance.noalias() += weighed_ * weighed_.transpose();
    cross_.noalias() = triangle() * weighed_.transpose();
    gain_ = weigh(correction_, cross_, innovation_factor_);
    step_.noalias() = gain_ * correction_.innovation;
    estimate_.mean.noalias() += directions_ * step_;
    take_in_outputs();
    formed_ = false;
    check();
  }

  const Gaussian& estimate() const override {
    if (formed_) return estimate_;
    estimate_.factor = formed_factor();
    if (with_covariance_) estimate_.covariance = covariance_of(estimate_.factor);
    formed_ = true;
    return estimate_;
  }
  Gaussian marginal(const std::vector<Index>& entries) const override {
    return {estimate_.mean(entries), {}, directions_(entries, Eigen::all) * root_.matrix()};
  }
  std::vector<std::string> remarks() const override { return limit_.remarks(); }

 private:
  void factorise_process_noise() {
    const MatrixXd& q = model_.process_noise();
    process_ = q.size() > 0 && !q.isZero(0.0) ? factor_of(q) : MatrixXd();
    process_noise_changes_ = model_.process_noise_changes();
  }

  void restart() {
    root_.restart(directions_.cols());
    formed_ = false;
  }

  Eigen::TriangularView<const MatrixXd, Eigen::Upper> triangle() const {
    return root_.matrix().triangularView<Eigen::Upper>();
  }
  MatrixXd formed_factor() const { return directions_ * triangle(); }

  // Outputs of independent noise: L^-1 P y with R = P^T L diag(d) L^T P.
  void take_in_outputs() {
    if (!same(noise_, model_.output_noise())) decorrelate();
    independent_.noalias() = decorrelation_ * seen_;
    root_.take_in(independent_, variances_);
    if (++corrections_ % TriangularRoot::interval == 0 && root_.cancels()) {
      directions_ = formed_factor();
      restart();
    }
  }

  void decorrelate() {
    noise_ = model_.output_noise();
    const Eigen::LDLT<MatrixXd> factor(noise_);
    variances_ = factor.vectorD();
    decorrelation_ = factor.transpositionsP() * MatrixXd::Identity(noise_.rows(), noise_.rows());
    factor.matrixL().solveInPlace(decorrelation_);
  }

  void check() const {
    if (!estimate_.mean.allFinite())
      throw FilterFailure("the mean is not finite", std::numeric_limits<double>::quiet_NaN());
    if (!root_.matrix().allFinite())
      throw FilterFailure("the covariance is not finite", std::numeric_limits<double>::quiet_NaN());
  }

  RankLimit limit_;
  TriangularRoot root_;
  mutable Gaussian estimate_;
  mutable bool formed_ = false;
  bool with_covariance_ = false;
  int process_noise_changes_ = 0;
  Index corrections_ = 0;
  VectorXd next_, expected_, step_;
  MatrixXd directions_, process_, sensor_, seen_, weighed_, cross_, gain_;
  MatrixXd noise_, decorrelation_, independent_;
  VectorXd variances_;
  Eigen::LLT<MatrixXd> innovation_factor_;
};

const bool low_rank_ekf_registered = filter_registry().add(
    {"low_rank_ekf",
     "extended Kalman filter on a factor of the covariance: O(n r) a step",
     "[carlson1973], [jazwinski1970]",
     {{"rank", 0.0, "",
       "largest rank kept where process noise raises it; 0: the state's size up to 64, else the rank of the "
       "initial estimate"}},
     {contract::exact_on_linear_gaussian, contract::consistent},
     [](std::unique_ptr<DiscreteModel> model, const Options& options) {
       return std::make_unique<LowRankExtendedKalmanFilter>(std::move(model), options.number("rank"));
     }});

}  // namespace

}  // namespace beamid::filters
