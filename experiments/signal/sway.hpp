// The slow motion beneath an oscillation, and the size of the oscillation along a signal.
#pragma once

#include <Eigen/Core>

#include "experiments/signal/decimation.hpp"

namespace beamid::experiments {

/// The signal (M) less its mean under a Hann window of two periods, a period at each end left out: of e^(s t)
/// it leaves (1 - H(s)) e^(s t), so that frequency and damping stay what they are. 1 - H is 1 at the period's
/// own frequency f, 0.5 at f / 2, 0.04 at f / 8. The signal itself where it is shorter than the window.
DecimatedSignal without_sway(DecimatedSignal signal, double period);

/// The mean of a signal under a Hann window of two periods, a period at each end left out: what the former
/// takes out. Empty where it is shorter than the window.
Eigen::VectorXd sway(const DecimatedSignal& signal, double period);

// How large a vibration of one frequency is along a signal, and the offset that it rides on.

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
