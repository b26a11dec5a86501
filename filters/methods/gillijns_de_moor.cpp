// The unbiased minimum-variance filter for inputs d of which nothing is known beforehand: [gillijns2007b]
// where the sensors read them at once, [gillijns2007a] where they show a sample later, through the motion. d
// stands in the state z among the others (find_unknown_inputs) and is a new unknown at every sample. With P
// the covariance of z where d is known, and G the directions dz/dd,
//
//     e = y - h(z),   E = H G,   S = H P H^T + R,   W = E^T S^-1 E
//     d += dd,  dd = W^-1 E^T S^-1 e,   z += G dd + K (e - E dd),   K = P H^T S^-1
//     P += -K S K^T + L W^-1 L^T,   L = G - K E
//
// Where dh/dd has full rank, d is the input at this sample, and the noise Q of the model says how inputs run
// from sample to sample: x moves by g (d_k+1 - d_k) with g = Q_xd Q_dd^-1 (held: Q_xd = 0; a random walk:
// straight on average), so that G = [g; 1] and P = F' P F'^T + Q_xx - g Q_dx with F'_xd = F_xd - g F_dd.
// Elsewhere d is the input until this sample, and G that column of F. Where readings are too few for W, the
// input is what the model's process makes of it, by the extended Kalman filter. Parameters in z are estimated
// beside, by tangents.
#include <Eigen/QR>

#include "filters/innovation.hpp"
#include "filters/latent_inputs.hpp"
#include "filters/linearised_step.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Of columns in units that may differ by many powers of ten.
bool has_full_column_rank(MatrixXd matrix) {
  constexpr double rounding = 1e-8;
  if (matrix.rows() < matrix.cols()) return false;
  for (auto column : matrix.colwise()) {
    if (!(column.norm() > 0.0)) return false;
    column.normalize();
  }
  Eigen::ColPivHouseholderQR<MatrixXd> factor(matrix);
  factor.setThreshold(rounding);
  return factor.rank() == matrix.cols();
}

class UnbiasedMinimumVarianceFilter final : public Filter {
 public:
  UnbiasedMinimumVarianceFilter(std::unique_ptr<DiscreteModel> model, const std::vector<double>& inputs)
      : Filter(std::move(model)), unknown_(find_unknown_inputs("gillijns_de_moor", model_, inputs)) {}

  void reset(const Gaussian& estimate) override {
    estimate_ = as_matrix(estimate, model_);
    given_ = without(estimate_.covariance);
    directions_ = units();
    late_ = false;
  }

  void predict(const VectorXd& input) override {
    if (!unknown_.empty()) {
      model_.output_jacobian(estimate_.mean, input, sensor_);
      late_ = !has_full_column_rank(sensor_(Eigen::all, unknown_));
    }
    model_.linearised_transition(estimate_.mean, input, next_, tangent_);
    estimate_.mean.swap(next_);
    MatrixXd q = model_.process_noise();
    const Index n = estimate_.mean.size();
    if (q.size() == 0) q.setZero(n, n);
    if (late_) {
      given_ = without(tangent_ * without(estimate_.covariance) * tangent_.transpose() + q);
      directions_ = tangent_(Eigen::all, unknown_);
    } else {
      directions_ = units() + along(q);
      const MatrixXd own = tangent_ - directions_ * tangent_(unknown_, Eigen::all);
      given_ =
          without(own * estimate_.covariance * own.transpose() + q - directions_ * q(unknown_, Eigen::all));
    }
    step_.predict(estimate_, tangent_, model_.process_noise());
  }

  void take_in(const VectorXd& output, const VectorXd& input) override {
    model_.output(estimate_.mean, input, expected_);
    model_.output_jacobian(estimate_.mean, input, sensor_);
    correction_.innovation = output - expected_;
    const MatrixXd& noise = model_.output_noise();
    const MatrixXd shown = sensor_ * directions_;
    if (unknown_.empty() || !has_full_column_rank(shown)) {
      ++unseen_;
      step_.correct(estimate_, sensor_, noise, correction_);
      return;
    }
    // Judged as if the input were the model's process: nothing else says how far a reading may be off.
    const MatrixXd cross = estimate_.covariance * sensor_.transpose();
    correction_.innovation_covariance = sensor_ * cross + noise;
    weigh(correction_, cross, factor_);

    const MatrixXd held = given_ * sensor_.transpose(), s = sensor_ * held + noise;
    factor_.compute(s);
    if (factor_.info() != Eigen::Success) refuse(s);
    const MatrixXd gain = factor_.solve(held.transpose()).transpose();
    const MatrixXd white = factor_.matrixL().solve(shown);
    const MatrixXd spread =
        (white.transpose() * white).ldlt().solve(MatrixXd::Identity(white.cols(), white.cols()));
    const VectorXd moved = spread * white.transpose() * factor_.matrixL().solve(correction_.innovation);
    estimate_.mean += directions_ * moved + gain * (correction_.innovation - shown * moved);
    const MatrixXd open = directions_ - gain * shown;
    MatrixXd kept = -gain * sensor_;
    kept.diagonal().array() += 1.0;
    estimate_.covariance = kept * given_ * kept.transpose() + gain * noise * gain.transpose();
    estimate_.covariance += open * spread * open.transpose();
    symmetrise(estimate_.covariance);
    check_finite(estimate_);
  }

  const Gaussian& estimate() const override { return estimate_; }

  std::vector<std::string> remarks() const override {
    std::vector<std::string> all;
    if (unknown_.empty()) all.push_back("no unknown input: this is the extended Kalman filter");
    if (late_)
      all.push_back("no sensor reads the unknown inputs at once: each is that of the interval before");
    if (!unknown_.empty() && unseen_ > 1)
      all.push_back("too few readings for the unknown inputs at " + std::to_string(unseen_) +
                    " samples, where they are the model's process");
    return all;
  }

 private:
  MatrixXd without(MatrixXd covariance) const {
    covariance(unknown_, Eigen::all).setZero();
    covariance(Eigen::all, unknown_).setZero();
    return covariance;
  }
  // g of the other entries, 0 of the inputs themselves; none where an input has no noise.
  MatrixXd along(const MatrixXd& q) const {
    MatrixXd g = MatrixXd::Zero(q.rows(), static_cast<Index>(unknown_.size()));
    const MatrixXd own = q(unknown_, unknown_);
    if (unknown_.empty() || !(own.diagonal().minCoeff() > 0.0)) return g;
    g = own.ldlt().solve(q(unknown_, Eigen::all)).transpose();
    g(unknown_, Eigen::all).setZero();
    return g;
  }
  MatrixXd units() const {
    const Index n = estimate_.mean.size();
    return MatrixXd::Identity(n, n)(Eigen::all, unknown_);
  }

  std::vector<Index> unknown_;
  Gaussian estimate_;
  MatrixXd given_, directions_;  // P of z where the inputs are known (n x n), G (n x m)
  bool late_ = false;
  Index unseen_ = 0;  // samples
  LinearisedStep step_;
  Eigen::LLT<MatrixXd> factor_;
  VectorXd next_, expected_;
  MatrixXd tangent_, sensor_;
};

const bool gillijns_de_moor_registered = filter_registry().add(
    {"gillijns_de_moor",
     "unbiased minimum-variance filter for inputs that are entirely unknown",
     "[gillijns2007a], [gillijns2007b]",
     {unknown_inputs_option()},
     {contract::exact_on_linear_gaussian, contract::consistent, contract::identifies,
      contract::unknown_inputs},
     [](std::unique_ptr<DiscreteModel> model, const Options& options) {
       return std::make_unique<UnbiasedMinimumVarianceFilter>(std::move(model), options.numbers("inputs"));
     }});

}  // namespace
}  // namespace beamid::filters
