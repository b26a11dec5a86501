// From the prior to the posterior in steps: tempered sequential Monte Carlo.
#pragma once

#include <cstdint>
#include <vector>

#include "experiments/identify/posterior/likelihood.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

struct TemperedDraws {
  Eigen::MatrixXd draws;  ///< (q x N) of u, equally likely
  Eigen::VectorXd log_likelihood;
  double log_evidence = 0.0;
  int stages = 0;
  double acceptance = 0.0;  ///< of the last stage's moves
  std::size_t evaluations = 0;
};

/// Draws of the prior are weighted by L^(b' - b), drawn again and moved, b rising from 0 to 1 so that half of
/// them remain effective: TMCMC [ching2007] as a sequential Monte Carlo sampler [delmoral2006]. A move is
/// either a step of Newton's method with noise of its own inverse second derivative [martin2012] or a walk of
/// that covariance, accepted by Metropolis and Hastings, so that each place has its own width. Every particle
/// has its own random numbers: the same for any number of threads.
TemperedDraws tempered_draws(const Likelihood& likelihood, std::size_t particles, std::uint64_t seed,
                             const Progress& progress = unwatched);

}  // namespace beamid::experiments
