// The whole posterior of parameters: humps, evidence, draws.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "experiments/identify/posterior/likelihood.hpp"
#include "experiments/identify/posterior/samplers.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {

// A density to draw from that has all humps of a posterior: Student's t distributions.

// The separate maxima of a posterior density.

/// A maximum of ln L(u) - u^2 / 2 and the normal density that osculates it (Laplace).
struct Hump {
  Eigen::VectorXd top;         ///< u (q)
  double log_density = 0.0;    ///< there, of L(u) N(u; 0, 1)
  Eigen::MatrixXd covariance;  ///< (J^T J + 1)^-1 (q x q)
  double log_mass = 0.0;       ///< Laplace's: log_density + ln sqrt(det 2 pi covariance)
};

/// ln L(u) + ln N(u; 0, 1).
double posterior_log(const LikelihoodValue& value, const Eigen::VectorXd& u);

/// Where damped Newton steps from the starts (q x n) end, on all cores: those that differ, are worth at least
/// a millionth of the best by Laplace, and have a valley between them on the straight line, of half a nat at
/// least. The heaviest first.
std::vector<Hump> separate_humps(const Likelihood& likelihood, const Eigen::MatrixXd& starts);

class HumpMixture {
 public:
  static constexpr double freedom = 6.0;  ///< of the t distributions, whose tails outlast a normal's

  struct Part {
    double share = 0.0;
    Eigen::VectorXd centre;
    Eigen::LLT<Eigen::MatrixXd> root;  ///< of the scale matrix
  };

  /// Laplace's normal densities, with their masses.
  explicit HumpMixture(const std::vector<Hump>& humps);

  std::size_t size() const { return parts_.size(); }
  const Part& part(std::size_t hump) const { return parts_[hump]; }
  /// @param weights (n) of draws (q x n): moves the part to their mean and covariance, where enough of them
  /// count.
  void adapt(std::size_t hump, double share, const Eigen::MatrixXd& draws, const Eigen::VectorXd& weights);

  Eigen::VectorXd draw(std::size_t hump, filters::RandomStream& random) const;
  Eigen::VectorXd draw(filters::RandomStream& random) const;
  double log_density(const Eigen::VectorXd& u) const;
  double even_log_density(const Eigen::VectorXd& u) const;  ///< of the parts in equal shares
  /// The hump to which a place belongs: that of the largest share there.
  std::size_t hump(const Eigen::VectorXd& u) const;

 private:
  std::vector<Part> parts_;
  double mixed_log(const Eigen::VectorXd& u, bool even) const;
  double part_log(const Part& part, const Eigen::VectorXd& u) const;
};

// Evidence and the humps' weights by importance sampling.

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
