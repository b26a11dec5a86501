// Many seeded repetitions of one beam's test: is the printed run typical, and is the bound reached?
#pragma once

#include "experiments/studies/paper/beam_identification.hpp"

namespace beamid::experiments::paper {

/// Errors relative to the reference, over all trials.
struct TrialStatistics {
  int trials = 0;
  int diverged = 0;  ///< lost the motion; counted in the errors as they are
  double stiffness_mean_percent = 0, damping_mean_percent = 0;
  double stiffness_rms_percent = 0, damping_rms_percent = 0;
  double stiffness_bound_percent = 0, damping_bound_percent = 0;  ///< Cramer-Rao

  double damping_bound_ratio() const { return damping_rms_percent / damping_bound_percent; }
};

/// Random stream of a beam's trial; the printed run is trial 0.
std::uint64_t stream_of(int beam, int trial);

/// EKF with the exact discretisation on the tuned processing; the result does not depend on the number of
/// threads.
TrialStatistics repeat(const BeamCase& beam, int beam_number, int trials, std::uint64_t seed);

}  // namespace beamid::experiments::paper
