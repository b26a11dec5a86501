// When the logger of a virtual test samples, and what it reads then.
#pragma once

#include <Eigen/Core>

#include "experiments/config/experiment.hpp"

namespace beamid::experiments {

/// When the logger samples: `count` samples during the motion, and those before it.
struct SampleClock {
  Eigen::VectorXd time;     ///< (N) [s], from 0
  double event = 0.0;       ///< the motion's t = 0 on this clock [s]
  Eigen::Index before = 0;  ///< samples before it
  bool even = true;
};

SampleClock clock_of(const Acquisition& acquisition, const Simulation& settings, Eigen::Index count);

/// True readings (N) at the clock's instants from those at the steps of the integration. Before the motion
/// the beam is held where it starts: only displacements and strains show that.
Eigen::VectorXd readings_at(const SampleClock& clock, const Eigen::VectorXd& step_time,
                            const Eigen::VectorXd& values, Eigen::Index steps, Quantity quantity);

}  // namespace beamid::experiments
