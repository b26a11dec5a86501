// The slow motion beneath an oscillation, and the size of the oscillation along a signal.
#pragma once

#include <Eigen/Core>
#include <complex>

#include "experiments/signal/decimation.hpp"

namespace beamid::experiments {

/// The signal (M) less its mean under a Hann window of two periods, a period at each end left out: of e^(s t)
/// it leaves (1 - H(s)) e^(s t), so that frequency and damping stay what they are. 1 - H is 1 at the period's
/// own frequency f, 0.5 at f / 2, 0.04 at f / 8. The signal itself where it is shorter than the window.
DecimatedSignal without_sway(DecimatedSignal signal, double period);

/// The mean of a signal under a Hann window of two periods, a period at each end left out: what the former
/// takes out. Empty where it is shorter than the window.
Eigen::VectorXd sway(const DecimatedSignal& signal, double period);

/// 1 - H(s) of without_sway(): what became of e^(s t). @param rate s [rad/s]
std::complex<double> response_without_sway(std::complex<double> rate, double interval, double period);

/// Slow motion beneath an oscillation, such as a laser's or an integrator's drift.
struct Drift {
  double share = 0.0;      ///< root mean square over that of the oscillation
  double steepness = 0.0;  ///< its largest change within four periods, of all its range
};

/// What remains of the signal when the window of sway() passes over it twice: of an oscillation of that
/// period next to nothing, of a drift nearly all. A share of 0 where it turns more than three times, as a
/// slow mode does, or where the signal is shorter than ten periods or has fewer than 4 samples in one.
/// Instants half a period apart are looked at.
Drift drift_beneath(const Eigen::VectorXd& signal, double interval, double period);

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
