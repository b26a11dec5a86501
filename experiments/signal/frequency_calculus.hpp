// Integrals and derivatives by division and multiplication with i w in the spectrum.
#pragma once

#include <Eigen/Core>
#include <complex>

namespace beamid::experiments {

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
