// The whole posterior of parameters: humps, evidence, draws.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/identify/posterior/chain_convergence.hpp"
#include "experiments/identify/posterior/chains.hpp"
#include "experiments/identify/posterior/importance.hpp"
#include "experiments/identify/posterior/tempering.hpp"

namespace beamid::experiments {

struct PosteriorSettings {
  std::uint64_t seed = 1;
  std::size_t particles = 1000;         ///< of the tempering
  std::size_t importance_draws = 8000;  ///< of the evidence
  ChainSettings chains = {};
};

struct Posterior {
  TemperedDraws tempered;
  std::vector<Hump> humps;    ///< the heaviest first
  std::vector<double> share;  ///< of each, sum 1
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
  /// Why not to rely on it, a clause each; none: it has converged.
  std::vector<std::string> complaints() const;
};

inline constexpr double largest_r_hat = 1.01;  ///< [vehtari2021]
inline constexpr double fewest_effective_draws = 400;

/// Tempering from the prior finds where there is probability; from what it left and from `known` (q x n)
/// Newton's method climbs to the tops of the humps; importance sampling weighs them; chains draw.
/// @throws std::invalid_argument where the prior and what was measured exclude each other.
Posterior sample_posterior(const Likelihood& likelihood, const Eigen::MatrixXd& known,
                           const PosteriorSettings& settings, const Progress& progress = unwatched);

}  // namespace beamid::experiments
