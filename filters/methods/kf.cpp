// Kalman filter [kalman1960] for linear models, on square roots of its covariances [kaminski1971]:
//
//     predict   [A L, Q^1/2] = [L+, 0] U                                   P = L L^T,  U orthogonal
//     correct   [H L, R^1/2; L, 0] = [S^1/2, 0; K, L+] U                   m += K S^-1/2 (y - h(m))
//
// Nothing is subtracted from a covariance: it is positive however wide the prior. The rows that U mixes are
// sorted by their size, which keeps the small ones' digits beside large ones [cox1998].
//
// A model counts as linear while A = dF/dz and H = dh/dz stay as they were at first, a deviation away and at
// every step. They may change with the interval, and with the outputs that were measured.
#include <Eigen/QR>
#include <algorithm>
#include <limits>
#include <numeric>

#include "filters/covariance_factor.hpp"
#include "filters/filter.hpp"
#include "filters/innovation.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Lower L (k x k) with L L^T = sum over the columns of `wide` (k x l) of their squares.
MatrixXd triangle_of(const MatrixXd& wide) {
  const VectorXd size = wide.cwiseAbs().colwise().maxCoeff();
  std::vector<Index> order(static_cast<std::size_t>(wide.cols()));
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return size[a] > size[b]; });
  const Index k = wide.rows(), rows = std::max(k, wide.cols());
  MatrixXd tall = MatrixXd::Zero(rows, k);
  tall.topRows(wide.cols()) = wide(Eigen::all, order).transpose();
  const Eigen::HouseholderQR<MatrixXd> qr(tall);
  const MatrixXd upper = qr.matrixQR().topRows(k).triangularView<Eigen::Upper>();
  return upper.transpose();
}

class KalmanFilter final : public Filter {
 public:
  explicit KalmanFilter(std::unique_ptr<DiscreteModel> model) : Filter(std::move(model)) {}

  void reset(const Gaussian& estimate) override {
    check_estimate(estimate, model_);
    estimate_ = {estimate.mean, {}, factor_of(estimate)};
    transition_.forget();
    sensor_.forget();
    formed_ = false;
  }

  void predict(const VectorXd& input) override {
    const auto tangent_at = [&](const VectorXd& state, MatrixXd& tangent) {
      model_.linearised_transition(state, input, next_, tangent);
    };
    if (model_.interval() != interval_) transition_.forget();
    interval_ = model_.interval();
    require_constant(tangent_at, transition_, "transition");
    const MatrixXd& q = model_.process_noise();
    const MatrixXd noise = q.size() > 0 && !q.isZero(0.0) ? factor_of(q) : MatrixXd(next_.size(), 0);
    MatrixXd wide(next_.size(), estimate_.factor.cols() + noise.cols());
    wide.leftCols(estimate_.factor.cols()).noalias() = transition_.value * estimate_.factor;
    wide.rightCols(noise.cols()) = noise;
    estimate_ = {next_, {}, triangle_of(wide)};
    formed_ = false;
    check();
  }

  void take_in(const VectorXd& output, const VectorXd& input) override {
    const auto sensor_at = [&](const VectorXd& state, MatrixXd& sensor) {
      model_.output(state, input, next_);
      model_.output_jacobian(state, input, sensor);
    };
    if (model_.observed() != observed_) sensor_.forget();
    observed_ = model_.observed();
    require_constant(sensor_at, sensor_, "output");

    const Index n = estimate_.mean.size(), p = output.size(), r = estimate_.factor.cols();
    const MatrixXd noise = factor_of(model_.output_noise());
    MatrixXd wide = MatrixXd::Zero(p + n, r + noise.cols());
    wide.topLeftCorner(p, r).noalias() = sensor_.value * estimate_.factor;
    wide.topRightCorner(p, noise.cols()) = noise;
    wide.bottomLeftCorner(n, r) = estimate_.factor;
    const MatrixXd after = triangle_of(wide);
    const auto root = after.topLeftCorner(p, p).triangularView<Eigen::Lower>();
    correction_.innovation = output - next_;
    correction_.innovation_covariance = covariance_of(MatrixXd(root));
    weigh(correction_, MatrixXd(0, p), factor_);
    estimate_.mean.noalias() += after.bottomLeftCorner(n, p) * root.solve(correction_.innovation);
    estimate_.factor = after.bottomRightCorner(n, n);
    formed_ = false;
    check();
  }

  const Gaussian& estimate() const override {
    if (!formed_) estimate_.covariance = covariance_of(estimate_.factor);
    formed_ = true;
    return estimate_;
  }

 private:
  struct Jacobian {
    MatrixXd value, rounding, known, known_rounding;  // at the mean, and as it has to remain
    void forget() { known.resize(0, 0); }
  };

  // The Jacobian at the mean; a deviation away, and wherever the mean was before, it has to be the same.
  template <class JacobianAt>
  void require_constant(const JacobianAt& at, Jacobian& jacobian, const char* what) {
    const auto evaluate = [&](const VectorXd& state) {
      at(state, jacobian.value);
      // Of differences in place of derivatives: rounding of the terms over the step.
      const VectorXd terms = jacobian.value.cwiseAbs() * state.cwiseAbs() + next_.cwiseAbs();
      jacobian.rounding = 1e-8 * terms * state.cwiseAbs().cwiseMax(1e-3).cwiseInverse().transpose();
    };
    if (jacobian.known.size() == 0) {
      const VectorXd deviation = estimate_.deviations();
      evaluate(estimate_.mean + (deviation.array() > 0.0).select(deviation, 1.0));
      jacobian.known = jacobian.value;
      jacobian.known_rounding = jacobian.rounding;
    }
    evaluate(estimate_.mean);
    for (Index j = 0; j < jacobian.value.cols(); ++j)
      for (Index i = 0; i < jacobian.value.rows(); ++i) {
        const double now = jacobian.value(i, j), before = jacobian.known(i, j);
        const double allowed = 1e-6 * std::max(std::abs(now), std::abs(before)) + jacobian.rounding(i, j) +
                               jacobian.known_rounding(i, j);
        if (!(std::abs(now - before) <= allowed))
          throw std::invalid_argument("kf: the model is not linear: the derivative of " + std::string(what) +
                                      " " + std::to_string(i + 1) + " by state " + std::to_string(j + 1) +
                                      " was " + std::to_string(before) + " and is " + std::to_string(now) +
                                      "; expected a constant (ekf or ukf take such models)");
      }
  }

  void check() const {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    if (!estimate_.mean.allFinite()) throw FilterFailure("the mean is not finite", unknown);
    if (!estimate_.factor.allFinite()) throw FilterFailure("the covariance is not finite", unknown);
  }

  mutable Gaussian estimate_;
  mutable bool formed_ = false;
  double interval_ = 0.0;
  std::vector<Index> observed_;
  VectorXd next_;
  Jacobian transition_, sensor_;
  Eigen::LLT<MatrixXd> factor_;
};

const bool kf_registered = filter_registry().add(
    {"kf",
     "Kalman filter for linear models, square-root array form",
     "[kalman1960], [kaminski1971]",
     {},
     {contract::exact_on_linear_gaussian, contract::consistent, contract::linear_models_only},
     [](std::unique_ptr<DiscreteModel> model, const Options&) {
       return std::make_unique<KalmanFilter>(std::move(model));
     }});

}  // namespace
}  // namespace beamid::filters
