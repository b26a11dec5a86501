// What a run shows about itself.
#pragma once

#include <optional>
#include <vector>

#include "filters/filter_run.hpp"
#include "filters/innovation_consistency.hpp"
#include "filters/whiteness.hpp"

namespace beamid::filters {

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
