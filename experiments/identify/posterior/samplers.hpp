// Two ways to draw from a posterior: tempered sequential Monte Carlo, and the No-U-Turn sampler.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "experiments/identify/posterior/likelihood.hpp"
#include "experiments/text/progress.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {

// One trajectory of the No-U-Turn sampler.

/// A place with its log density and slope.
struct ChainPlace {
  Eigen::VectorXd y;
  double log = 0.0;
  Eigen::VectorXd slope;
};

/// The density, in coordinates in which it is about as wide in every direction.
using ChainDensity = std::function<ChainPlace(const Eigen::VectorXd& y)>;

struct Trajectory {
  ChainPlace end;
  double acceptance = 0.0;  ///< mean of min(1, exp(-energy error))
  int leaps = 0;            ///< evaluations of the slope
  bool diverged = false;    ///< an energy error above 1000
};

/// Doublings of a leapfrog path until it turns back; the next place is drawn from it by multinomial weights
/// [hoffman2014]. The density is invariant exactly.
Trajectory no_u_turn(const ChainDensity& density, const ChainPlace& start, double step,
                     filters::RandomStream& random);

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
