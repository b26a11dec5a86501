// An estimator over seeded runs: does it err as much as it says, and no more than it must?
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "filters/filter_run.hpp"

namespace beamid::filters {

/// A record of which the truth is known.
struct Trial {
  Measurements record;
  Gaussian initial;       ///< what the filter starts from
  Eigen::VectorXd truth;  ///< of the entries that are estimated (k)
};

/// The same seed gives the same trial.
using TrialGenerator = std::function<Trial(std::uint64_t seed)>;
/// Estimate about the k entries, as covariance or factor; nothing: it failed.
using Estimator = std::function<std::optional<Gaussian>(const Trial&)>;

/// The filter's last estimate about some entries of the state; nothing where the run failed.
Estimator last_estimate_of(std::function<std::unique_ptr<Filter>()> make_filter,
                           std::vector<Eigen::Index> entries);

/// How many runs, and what their errors are compared with.
struct MonteCarloSettings {
  int runs = 2000;
  std::uint64_t first_seed = 1;        ///< run i has the seed first_seed + i
  Eigen::VectorXd bound = {};          ///< Cramer-Rao bound of each deviation (k); empty: none
  Eigen::VectorXd largest_error = {};  ///< a run that errs by more has diverged (k); empty: any error will do
};

/// From how often something happened, the band where its probability lies with 95 % [wilson1927].
struct Proportion {
  int count = 0, runs = 0;
  double lower_95 = 0.0, upper_95 = 1.0;
  double value() const { return runs > 0 ? static_cast<double>(count) / runs : 0.0; }
};

/// Errors are estimate - truth, of the runs that did not diverge.
struct MonteCarloResult {
  int runs = 0;
  Proportion diverged;  ///< failed, not finite, or beyond the largest error
  std::vector<std::uint64_t> diverged_seeds;
  Eigen::VectorXd bias;                 ///< mean error (k)
  Eigen::VectorXd bias_deviation;       ///< standard error of that mean (k)
  Eigen::VectorXd rms;                  ///< (k)
  Eigen::VectorXd rms_over_bound;       ///< empty without a bound (k)
  Eigen::VectorXd rms_over_deviation;   ///< rms error / rms of the deviation that the estimator told (k)
  double relative_rms_deviation = 0.0;  ///< standard error of the rms as a share of it: 1/sqrt(2 runs)
  std::vector<Proportion> coverage;     ///< of intervals of 1.96 deviations: 95 % when consistent (k)
  /// Mean of e^T P^-1 e / k, 1 when consistent, and where it lies in 99.9 % of such experiments
  /// [barshalom2001, sec. 5.4]; NaN where a P is singular.
  double nees = 0.0, nees_lower_999 = 0.0, nees_upper_999 = 0.0;

  bool consistent() const { return nees >= nees_lower_999 && nees <= nees_upper_999; }
};

/// @throws std::invalid_argument when runs < 1, or sizes disagree.
MonteCarloResult monte_carlo(const TrialGenerator& generate, const Estimator& estimate,
                             const MonteCarloSettings& settings = {});

/// Wilson's score interval. @throws std::invalid_argument unless 0 <= count <= runs and runs >= 1.
Proportion proportion(int count, int runs);

}  // namespace beamid::filters
