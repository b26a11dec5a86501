// A free decay in windows of falling amplitude, each identified as a linear oscillator.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

struct WindowSettings {
  double amplitude_ratio = 0.8;  ///< a window ends where the amplitude has fallen to this part of its first
  double fewest_cycles = 3;      ///< but is no shorter than this
  double mass = 1;               ///< [kg]
  std::optional<std::pair<double, double>> band_hz = {};  ///< where the mode is at its largest
};

/// What the linear joint filter says of one window. Amplitudes are those of the displacement's first
/// harmonic [m].
struct AmplitudeWindow {
  double from = 0, to = 0;                        ///< [s]
  double amplitude = 0;                           ///< to which stiffness and damping belong
  double frequency_hz = 0;                        ///< undamped
  double stiffness = 0, stiffness_deviation = 0;  ///< K [N/m]
  double damping = 0, damping_deviation = 0;      ///< C [N s/m]
  double damping_ratio = 0;
  double fall = 0;  ///< -d ln(amplitude) / dt of the displacement [1/s]
  double left = 0;  ///< rms of what the damped sine leaves, of the low-passed signal [unit of the signal]
  /// A stiffness that changes within the window is seen as sum_j w_j K(A_j): nodes of equal length in time.
  Eigen::VectorXd nodes, weights;
};

struct AmplitudeWindows {
  std::vector<AmplitudeWindow> windows;
  double noise = 0;                                ///< median over the windows of what they leave
  double first_amplitude = 0, last_amplitude = 0;  ///< where the windows begin and end [m]
  std::complex<double> start;                      ///< displacement at the first sample of the record [m]
  double largest_other = 0;  ///< line beside the mode, relative to the mode, in the first window
  int decimation = 1;
  std::string ended;  ///< why no further window was taken
};

/// Of the first channel of motion: low-passed and decimated to eight samples per period, which leaves the
/// first harmonic as it was and ends modes above 5.6 times its frequency. In each window a damped sine is
/// fitted by least squares; the joint filter of [inverse2009] (model sdof, exact transition, R from what the
/// sine leaves of the window, no less than the median) finds K and C. The first harmonic of an acceleration a
/// is that of a displacement a / omega^2, omega running from window to window: no integration, so none of its
/// drift.
///
/// A frequency that changes by d within a window of the length L leaves the phase d L / 8 at its ends, of the
/// variance 4/45 (d L / 8)^2 beside the fitted sine's, whose amplitude it makes too small by half of that:
/// made good.
///
/// Nodes and weights: the phase's slope that least squares find in a decay W(t) = A(t)^2 is
/// int g(s) omega(s) ds, g(s) = int_s^L W (t - mean) dt / int W (t - mean)^2 dt; so is the decay rate.
/// @throws std::invalid_argument where there is no mode or not one window.
AmplitudeWindows amplitude_windows(const Record& record, const WindowSettings& settings);

}  // namespace beamid::experiments
