// One trajectory of the No-U-Turn sampler.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "filters/random.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
