// From a clean acceleration of the first mode to displacement and velocity, with one thing done wrong.
#pragma once

#include <functional>
#include <vector>

#include "experiments/signal/cascaded_filter.hpp"
#include "experiments/studies/paper/beam_identification.hpp"

namespace beamid::experiments::paper {

/// Displacement and velocity, and the first sample that the filter reads.
struct ChainMotion {
  Eigen::VectorXd displacement, velocity;
  Eigen::Index first = 0;
};

/// The first mode's acceleration, exact and without noise, and the high-pass of 2009.
struct CleanMode {
  Eigen::VectorXd acceleration;
  CascadedFilter high_pass;
  double interval = 0.0;     ///< [s]
  Eigen::Index settled = 0;  ///< samples until the high-pass's transient is gone
};
CleanMode clean_mode(const BeamCase& beam);

struct Alternative {
  const char* name;
  std::function<ChainMotion(const CleanMode&)> chain;
};
const std::vector<Alternative>& compared_alternatives();

}  // namespace beamid::experiments::paper
