// Noise and prior as functions of a few logarithms.
#pragma once

#include "filters/noise_estimation.hpp"

namespace beamid::filters {

/// The log-likelihood of a record as a function of x = log s, the levels as NoiseSettings tells.
class NoiseLevels {
 public:
  /// @throws std::invalid_argument as estimate_noise() does; what is passed must outlive it.
  NoiseLevels(const NoisyFilterFactory& make_filter, const Gaussian& initial,
              const Measurements& measurements, const NoiseSettings& settings);

  Eigen::Index size() const { return size_; }  ///< q
  int runs() const { return runs_; }
  Noise noise(const Eigen::VectorXd& x) const;
  Gaussian initial(const Eigen::VectorXd& x) const;
  Measurements measurements(const Eigen::VectorXd& x) const;

  /// log p(y); minus infinity where the filter fails.
  double log_likelihood(const Eigen::VectorXd& x);
  /// The levels that maximise the expected log-likelihood of states and outputs, given the smoothed states
  /// [shumway1982]; sets the log-likelihood of x. Nothing where the filter fails.
  Eigen::VectorXd expectation_maximisation(const Eigen::VectorXd& x, double& log_likelihood);

 private:
  Eigen::VectorXd scales(const std::vector<std::vector<Eigen::Index>>& groups, Eigen::Index first,
                         Eigen::Index size, const Eigen::VectorXd& x) const;
  void check_diagonal() const;

  const NoisyFilterFactory& make_filter_;
  const Gaussian& initial_;
  const Measurements& measurements_;
  const NoiseSettings& settings_;
  std::vector<std::vector<Eigen::Index>> outputs_;
  Eigen::Index size_ = 0;
  int runs_ = 0;
};

}  // namespace beamid::filters
