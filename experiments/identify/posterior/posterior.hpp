// The whole posterior of parameters: humps, evidence, draws.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/identify/posterior/hump_mixture.hpp"
#include "experiments/identify/posterior/tempering.hpp"

namespace beamid::experiments {

// The standard normal distribution: both tails to full relative accuracy.

double below_normal(double u);         ///< Phi(u)
double normal_quantile(double share);  ///< u of Phi(u); infinite at 0 and 1
double normal_density(double u);       ///< Phi'(u)

// Markov chains of a posterior that cross from hump to hump.

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

// Whether chains agree, and how many independent draws they are worth.

struct ChainConvergence {
  double r_hat = 1.0;  ///< the larger of that of the place and that of the spread
  double effective_draws = 0.0;
};

/// R-hat of one quantity, of halves of chains, by ranks; the smallest effective number of draws of its place,
/// its 5 % and its 95 % quantile [vehtari2021].
/// @param draws (draws x chains)
ChainConvergence chain_convergence(const Eigen::MatrixXd& draws);

struct PosteriorSettings {
  std::uint64_t seed = 1;
  std::size_t particles = 1000;         ///< of each of two temperings
  std::size_t prior_climbs = 200;       ///< climbs from draws of the prior, which no tempering has led astray
  std::size_t importance_draws = 8000;  ///< of the evidence
  ChainSettings chains = {};
};

struct Posterior {
  TemperedDraws tempered;  ///< of the tempering with the larger evidence; the mean of both as the evidence
  double tempered_apart = 0.0;  ///< of the two evidences [nat]
  std::vector<Hump> humps;      ///< the heaviest first
  std::vector<double> share;    ///< of each, sum 1
  ImportanceSample importance;
  std::vector<PosteriorChain> chains;
  std::vector<std::vector<std::size_t>> hump_of;  ///< of each chain's draws
  std::vector<double> chain_share;                ///< of each hump among the draws
  std::vector<ChainConvergence> convergence;      ///< of each coordinate, then of the log density
  std::size_t evaluations = 0;

  /// Humps of at least a hundredth of the probability.
  std::size_t notable_humps() const;
  double log_evidence() const { return importance.poor() ? tempered.log_evidence : importance.log_evidence; }
  double worst_r_hat() const;
  double fewest_effective() const;
  std::size_t divergences() const;
  std::size_t draws() const;
  /// The temperings hold more evidence than the humps that were found, or, where importance sampling cannot
  /// weigh those, disagree: humps may be missing.
  bool humps_are_uncertain() const;
  /// That, or chains that have not met: no number to rely on.
  bool disagrees() const { return humps_are_uncertain() || worst_r_hat() > 1.05; }
  Eigen::VectorXd best_draw() const;  ///< u of the largest posterior density that a chain or a climb met
  /// Why not to rely on it, a clause each; none: it has converged.
  std::vector<std::string> complaints() const;
};

inline constexpr double largest_r_hat = 1.01;  ///< [vehtari2021]
inline constexpr double fewest_effective_draws = 400;

/// Two independent temperings from the prior find where there is probability; from what they left, from draws
/// of the prior and from `known` (q x n) Newton's method climbs to the tops of the humps; importance sampling
/// weighs them; chains draw.
/// @throws std::invalid_argument where the prior and what was measured exclude each other.
Posterior sample_posterior(const Likelihood& likelihood, const Eigen::MatrixXd& known,
                           const PosteriorSettings& settings, const Progress& progress = unwatched);

}  // namespace beamid::experiments
