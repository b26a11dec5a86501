// How large a vibration of one frequency is along a signal, and the offset that it rides on.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

/// At M instants, a quarter of a period apart: the middles of windows of two periods.
struct LocalMotion {
  Eigen::VectorXd time;       ///< (M) [s], from the first sample
  Eigen::VectorXd amplitude;  ///< (M) of the vibration [unit of the signal]
  Eigen::VectorXd offset;     ///< (M), of what changes slowly [unit of the signal]

  static constexpr double windows_per_period = 4;
};

/// Least squares of a parabola and a sine at the frequency in every window: drifts and the end of a start-up
/// are left to the parabola. A frequency that is a quarter off still gives most of the amplitude.
/// Empty where the signal (N) is shorter than a window, or a period has fewer than four samples.
LocalMotion local_motion(const Eigen::VectorXd& signal, double interval, double frequency_hz);

}  // namespace beamid::experiments
