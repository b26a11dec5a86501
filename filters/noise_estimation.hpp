// Noise levels from the record itself: by the highest likelihood, and by expectation-maximisation.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "filters/filter_run.hpp"

namespace beamid::filters {

/// The filter that is to be used, on its model with this noise.
using NoisyFilterFactory = std::function<std::unique_ptr<Filter>(const Noise&)>;

/// ln p(y) of a record, by that filter, under each of several noises; minus infinity where it fails.
using NoisyLikelihoods = std::function<std::vector<double>(const std::vector<Noise>&)>;

/// By which method the levels are found.
enum class NoiseMethod {
  maximum_likelihood,       ///< Newton's method on the filter's log-likelihood
  expectation_maximisation  ///< [shumway1982], by the smoother; for diagonal R and Q
};

/// A level multiplies deviations: R_ij = s_i s_j R0_ij, Q_ij = s_i s_j Q0_ij, P_0 = s^2 P0_0, with one s for
/// all members of a group.
struct NoiseSettings {
  Noise guess;  ///< R0 (p x p) and Q0 (n x n); what is not estimated remains so
  std::vector<std::vector<Eigen::Index>> output_groups = {};   ///< of outputs; empty: each output is one
  std::vector<std::vector<Eigen::Index>> process_groups = {};  ///< of states; empty: Q is known
  bool initial_level = false;  ///< whether the initial covariance has a level too
  NoiseMethod method = NoiseMethod::maximum_likelihood;
  int max_iterations = 200;
  /// Converged when the next step would change no level by more than this share, or raise the log-likelihood
  /// by less than 1e-9 or, by maximum likelihood, than its rounding, 1e-13 of it.
  double tolerance = 1e-6;
  /// Where the likelihoods of this very record and initial estimate can be had at less cost than by runs of
  /// the filter, several side by side; empty: by runs. Maximum likelihood with no initial level only.
  NoisyLikelihoods likelihoods = {};
};

enum class NoiseStatus { converged, iterations_exhausted, failed };

/// Noise levels with their standard errors.
struct NoiseEstimate {
  NoiseStatus status = NoiseStatus::failed;
  std::string reason;  ///< in words, unless converged
  Noise noise;         ///< R and Q at the estimate
  Gaussian initial;    ///< as given, its covariance scaled
  /// s of the output groups, then the process groups, then the initial covariance (q).
  Eigen::VectorXd levels;
  /// Standard errors of log s, hence of s as a share of it, from the curvature of the log-likelihood;
  /// infinity where it is not curved: the record does not tell the level, or tells that it is zero (q).
  Eigen::VectorXd relative_deviations;
  double log_likelihood = 0.0;
  std::vector<double> log_likelihoods;  ///< of the guess and after every iteration
  int runs = 0;                         ///< of the filter over the record
};

/// Maximum likelihood of noise levels: the s that maximise the filter's log-likelihood of the record,
/// log p(y) = sum_k log N(innovation_k; 0, S_k). Exact on linear-Gaussian models; elsewhere that of the
/// filter's approximation. Where the record has deviations of its own for every sample, output levels
/// multiply them.
/// @throws std::invalid_argument when shapes disagree, an index does not exist or is in two groups, a level
/// would multiply zero, or expectation-maximisation is asked of noises that are correlated.
NoiseEstimate estimate_noise(const NoisyFilterFactory& make_filter, const Gaussian& initial,
                             const Measurements& measurements, const NoiseSettings& settings);

// Noise and prior as functions of a few logarithms.

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
  double log_likelihood(const Eigen::VectorXd& x) { return log_likelihoods({x}).front(); }
  /// The same of several x, side by side where NoiseSettings::likelihoods can.
  std::vector<double> log_likelihoods(const std::vector<Eigen::VectorXd>& places);
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
