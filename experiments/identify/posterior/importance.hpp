// Evidence and the humps' weights by importance sampling.
#pragma once

#include <cstdint>
#include <vector>

#include "experiments/identify/posterior/hump_mixture.hpp"

namespace beamid::experiments {

struct ImportanceSample {
  double log_evidence = 0.0, standard_error = 0.0;  ///< [nat]
  std::vector<double> share;                        ///< of each hump, by their masses
  double effective_share = 0.0;  ///< effective draws over those made: 1 where the mixture is the posterior
  std::size_t evaluations = 0;
  /// Too few draws count for the numbers above to be relied upon.
  bool poor() const { return effective_share < 0.05; }
};

/// As many draws from each part of the mixture, weighted by L N / mixture (all parts of it), two rounds of
/// which move the parts to the humps' means and covariances [cappe2008]. The draws of a last round, which
/// moves nothing, count.
ImportanceSample importance_sample(const Likelihood& likelihood, HumpMixture& mixture, std::size_t draws,
                                   std::uint64_t seed);

}  // namespace beamid::experiments
