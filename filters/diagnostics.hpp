// Diagnostics of a run: whether its innovations are as the filter assumes, and what the record adds.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "filters/filter_run.hpp"

namespace beamid::filters {

// Is a series white?

/// How far a series is from white noise.
struct Whiteness {
  Eigen::VectorXd autocorrelation;  ///< at lags 1 to L (L); 0 when white
  double p_value = 0.0;             ///< Ljung-Box test over these lags [ljung1978]; below 0.05: not white
};

/// Of a series (N) whose NaN entries are missing. With r_k the correlation at lag k, of the n_k pairs that
/// are there, and n entries that are there,
///
///     Q = n (n + 2) sum_k r_k^2 / n_k
///
/// is chi-square of as many degrees as lags have pairs; n_k = n - k where nothing is missing. A series that
/// is constant, or beyond all bounds, has correlations of one.
Whiteness whiteness_of(const Eigen::VectorXd& series, Eigen::Index lags = 20);

/// Tests of a run's innovations, all of which a consistent filter passes most of the time. Outputs that were
/// not measured do not count.
struct InnovationConsistency {
  double mean_normalised_square = 0;  ///< over the outputs: 1 when S has the right size
  double lower_95 = 0,
         upper_95 = 0;      ///< where 95 % of consistent runs of this length lie [barshalom2001, sec. 5.4]
  Eigen::VectorXd windows;  ///< the same mean over ten successive parts of the record
  double window_lower_95 = 0,
         window_upper_95 = 0;  ///< where all ten lie in 95 % of consistent runs (Bonferroni)
  /// Of successive whitened innovations of the first output; 0 when white.
  double lag_one_correlation = 0;
  double whiteness_p_value = 0;  ///< Ljung-Box test over 20 lags [ljung1978]; below 0.05: not white

  bool size_is_right() const {
    return mean_normalised_square >= lower_95 && mean_normalised_square <= upper_95;
  }
  bool size_is_steady() const {
    return windows.minCoeff() >= window_lower_95 && windows.maxCoeff() <= window_upper_95;
  }
  bool white() const { return whiteness_p_value >= 0.05; }
};

/// @throws std::invalid_argument when fewer than 100 samples were reached and told something.
InnovationConsistency innovation_consistency(const FilterRun& run);

// What a run shows about itself.

/// Whitened innovations, which are N(0, 1) when the filter is consistent, counted.
struct InnovationHistogram {
  Eigen::VectorXd edges;     ///< of the bins, increasing, from -5 to 5 (b + 1)
  Eigen::MatrixXd counts;    ///< per output; what lies beyond counts in the outermost bin (p x b)
  Eigen::MatrixXd expected;  ///< counts of N(0, 1) (p x b)
};

/// What the record has told about r unknowns, against what was known before: with the prior covariance P_0
/// and the last one P, both scaled by the prior deviations, the ratio w = variance after / before along each
/// generalised eigenvector of (P, P_0).
struct InformationGain {
  Eigen::VectorXd ratios;        ///< w, smallest first (r)
  Eigen::MatrixXd combinations;  ///< in units of the prior deviations, of length 1, in its columns (r x r)
  Eigen::Index rank = 0;         ///< combinations of which the record says more than the prior did: w < 1/2
  double condition = 0.0;  ///< of the record's information 1/w - 1: largest / smallest; infinity: none there
};

/// All of it.
struct Diagnostics {
  std::optional<InnovationConsistency> consistency;  ///< nothing below 100 samples
  std::vector<Whiteness> whiteness;                  ///< of each output (p)
  InnovationHistogram histogram;
  std::optional<InformationGain>
      information;  ///< nothing where no unknowns are asked about, or known exactly
  double log_likelihood = 0.0;
};

/// @param unknowns entries of the state (r). @throws std::invalid_argument when one does not exist.
Diagnostics diagnose(const FilterRun& run, const Gaussian& initial,
                     const std::vector<Eigen::Index>& unknowns = {});

/// @throws std::invalid_argument when the matrices are not square, of one size and finite.
std::optional<InformationGain> information_gain(const Eigen::MatrixXd& before, const Eigen::MatrixXd& after);

/// @throws std::invalid_argument when bins < 2
InnovationHistogram innovation_histogram(const FilterRun& run, Eigen::Index bins = 40);

}  // namespace beamid::filters
