// Markov chains of a posterior that cross from hump to hump.
#pragma once

#include <cstdint>
#include <vector>

#include "experiments/identify/posterior/hump_mixture.hpp"

namespace beamid::experiments {

struct ChainSettings {
  std::size_t chains = 4, draws = 1000, warm_up = 200;
};

struct PosteriorChain {
  Eigen::MatrixXd draws;  ///< (q x draws) of u
  Eigen::VectorXd log_posterior;
  std::size_t jumps = 0;  ///< proposals of the mixture that were accepted
  std::size_t divergences = 0, leaps = 0;
  double step = 0.0;
};

/// Each draw is a trajectory of the No-U-Turn sampler, in coordinates whitened by the humps' common
/// covariance, after a proposal of the mixture, accepted by Metropolis and Hastings [tierney1994], which
/// crosses valleys. Both leave the posterior as it is. Steps are found in the warm-up (dual averaging
/// [hoffman2014]). A chain has its own random numbers.
/// @param starts (q x n) of draws of the posterior, one for each chain
std::vector<PosteriorChain> posterior_chains(const Likelihood& likelihood, const HumpMixture& mixture,
                                             const Eigen::MatrixXd& starts, const ChainSettings& settings,
                                             std::uint64_t seed);

}  // namespace beamid::experiments
