// An algorithm of sizes known at run time as a filter of the registry.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "filters/algorithms/extended_kalman.hpp"
#include "filters/algorithms/observed.hpp"
#include "filters/algorithms/square_root_kalman.hpp"
#include "filters/algorithms/unscented_kalman.hpp"
#include "filters/filter.hpp"
#include "filters/innovation.hpp"

namespace beamid::filters::algorithms {

using DynamicExtendedKalman = ExtendedKalman<double, Eigen::Dynamic, Eigen::Dynamic>;
using DynamicUnscentedKalman = UnscentedKalman<double, Eigen::Dynamic, Eigen::Dynamic>;
using DynamicSquareRootKalman = SquareRootKalman<double, Eigen::Dynamic, Eigen::Dynamic>;

template <class Algorithm>
class RegisteredFilter final : public Filter {
 public:
  template <class... Arguments>
  explicit RegisteredFilter(std::unique_ptr<DiscreteModel> model, const Arguments&... arguments)
      : Filter(std::move(model)), at_step_(model_), algorithm_(arguments...) {}

  void reset(const Gaussian& estimate) override {
    check_estimate(estimate, model_);
    algorithm_.mean = estimate.mean;
    if constexpr (carries_root)
      set_root(estimate);
    else
      algorithm_.covariance = with_covariance(estimate).covariance;
    formed_ = false;
  }

  void predict(const Eigen::VectorXd& input) override {
    at_step_.set_input(input);
    formed_ = false;
    algorithm_.predict(at_step_);
    check();
  }

  void take_in(const Eigen::VectorXd& output, const Eigen::VectorXd& input) override {
    at_step_.set_input(input);
    algorithm_.look(at_step_, output);
    const auto& seen = algorithm_.seen;
    if (!(seen.smallest_pivot > 0.0)) refuse(seen.covariance);
    correction_.innovation = seen.innovation;
    correction_.innovation_covariance = seen.covariance;
    correction_.whitened = seen.whitened;
    correction_.normalised_square = seen.normalised_square;
    const double log_determinant = 2.0 * seen.root.diagonal().array().log().sum();
    const double constant = static_cast<double>(output.size()) * std::log(2.0 * std::numbers::pi);
    correction_.log_likelihood = -0.5 * (seen.normalised_square + log_determinant + constant);
    formed_ = false;
    algorithm_.update(at_step_);
    check();
  }

  const Gaussian& estimate() const override {
    if (formed_) return estimate_;
    estimate_.mean = algorithm_.mean;
    if constexpr (carries_root) {
      estimate_.factor = algorithm_.root;
      estimate_.covariance = covariance_of(algorithm_.root);
    } else {
      estimate_.covariance = algorithm_.covariance;
    }
    formed_ = true;
    return estimate_;
  }

 private:
  static constexpr bool carries_root = std::is_same_v<Algorithm, DynamicSquareRootKalman>;

  void set_root(const Gaussian& estimate) {
    if (estimate.factor.size() == 0) return lower_root(estimate.covariance, algorithm_.root);
    const Eigen::Index n = estimate.factor.rows(), r = estimate.factor.cols();
    Eigen::MatrixXd array = Eigen::MatrixXd::Zero(std::max(n, r), n);
    array.topRows(r) = estimate.factor.transpose();
    triangularise(array, algorithm_.root);
  }
  void check() const {
    if constexpr (carries_root) {
      if (!algorithm_.mean.allFinite() || !algorithm_.root.allFinite()) check_finite(estimate());
    } else {
      check_finite(algorithm_.mean, algorithm_.covariance);
    }
  }

  Observed at_step_;
  Algorithm algorithm_;
  mutable Gaussian estimate_;
  mutable bool formed_ = false;
};

}  // namespace beamid::filters::algorithms
