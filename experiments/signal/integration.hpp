// From acceleration to velocity and displacement, in time and in the spectrum.
#pragma once

#include <complex>
#include <optional>

#include <Eigen/Core>

#include "experiments/signal/butterworth.hpp"

namespace beamid::experiments {

/// Trapezoidal integral y_k = y_(k-1) + dt/2 (x_(k-1) + x_k) of a signal (N) from y_0 = `first`.
///
/// On e^(s t) its factor is trapezoidal_response. With first = dt/2 x_0 it is the filter started from rest.
Eigen::VectorXd cumulative_trapezoid(const Eigen::VectorXd& signal, double interval, double first = 0);

/// dt/2 (z + 1)/(z - 1) with z = e^(s dt), instead of the exact 1/s.
std::complex<double> trapezoidal_response(std::complex<double> rate, double interval);

/// How acceleration becomes velocity and displacement.
struct ProcessingSettings {
  double high_pass_hz = 0.5;
  int high_pass_order = 2;            ///< 1 leaves a drift in displacement; 3 or more remove a sensor's bias
  std::optional<double> low_pass_hz;  ///< against higher modes and noise
  int low_pass_order = 4;
  bool zero_phase = false;            ///< forwards and backwards: no phase shift, but transients at both ends
  double transient_tolerance = 1e-3;  ///< what counts as settled, relative to the transient's beginning
};

/// The three histories (N each), and the samples [settled_begin, settled_end) that transients of the filter
/// leave alone. Outside them the histories are not those of the motion.
struct ProcessedMotion {
  Eigen::VectorXd acceleration;  ///< filtered [m/s2]
  Eigen::VectorXd velocity;      ///< [m/s]
  Eigen::VectorXd displacement;  ///< [m]
  Eigen::Index settled_begin = 0;
  Eigen::Index settled_end = 0;  ///< not above settled_begin when the record is too short to settle
};

/// The filter that the settings describe: high-pass, then low-pass where there is one.
CascadedFilter processing_filter(const ProcessingSettings& settings, double interval);

/// Acceleration (N) [m/s2] -> high-pass, optional low-pass -> velocity -> displacement, by the trapezoidal
/// rule.
///
/// Causal: filter and integrals all start from rest, which makes the chain one linear filter: after the
/// transient a mode e^(s t) keeps its frequency and damping, and a double integral cannot run away, as the
/// high-pass cancels its double pole. Integrating from zero instead would add the ramp a_0 dt/2 t.
///
/// Zero-phase: integrated first, with the means removed, then each of the three filtered forwards and
/// backwards once, so that all three carry the same factor zero_phase_response(s).
/// @throws std::invalid_argument on bad settings or fewer than two samples.
ProcessedMotion process_acceleration(const Eigen::VectorXd& acceleration, double interval,
                                     const ProcessingSettings& settings);

// Integrals and derivatives by division and multiplication with i w in the spectrum.

/// Weight of a frequency f in an integral: 0 below half the corner, 1 above it, half a cosine in between.
double above_corner(double frequency_hz, double corner_hz);

/// `times`-fold integral of a signal (N), X(f) / (i 2 pi f)^times, without what lies below the corner: an
/// oscillation e^(s t) above it leaves as e^(s t) / s^times, without the error of the trapezoidal rule and
/// without drift.
///
/// The signal is continued by its even reflection, which has no jump, falling smoothly to zero; what its ends
/// have below the corner is lost there: what that leaves fades over some 3 / corner.
/// @throws std::invalid_argument unless 0 < corner < half the sampling rate, times is 1 or 2, and N >= 2.
Eigen::VectorXd integrate_in_frequency(const Eigen::VectorXd& signal, double interval, int times,
                                       double corner_hz);

/// `times`-fold derivative, (i 2 pi f)^times X(f), exact for all that lies below half the sampling rate. The
/// line through the signal's ends is set aside and the rest continued by its odd reflection, which has
/// neither jump nor kink at the ends but a second derivative that changes sign there.
/// @throws std::invalid_argument unless times is 1 or 2 and N >= 2.
Eigen::VectorXd differentiate_in_frequency(const Eigen::VectorXd& signal, double interval, int times);

}  // namespace beamid::experiments
